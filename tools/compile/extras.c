/* Reading extras. Input: the JSON text that the importer kept; output: the few keys that the compiler obeys. */
#include "compile/extras.h"

#include <cJSON.h>
#include <string.h>

static void read_text(const cJSON *object, const char *key, char out[ENF_EXTRAS_NAME]) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    if (out[0] == '\0' && cJSON_IsString(item) && strlen(item->valuestring) < ENF_EXTRAS_NAME) {
        strcpy(out, item->valuestring);
    }
}

static bool read_bool(const cJSON *object, const char *key, bool standard) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    if (cJSON_IsBool(item)) {
        return cJSON_IsTrue(item);
    }
    if (cJSON_IsNumber(item)) {
        return item->valuedouble < 0.0 || item->valuedouble > 0.0;
    }
    if (cJSON_IsString(item) && strcmp(item->valuestring, "true") == 0) {
        return true;
    }
    if (cJSON_IsString(item) && strcmp(item->valuestring, "false") == 0) {
        return false;
    }
    return standard;
}

static void read_priority(const cJSON *object, EnfExtras *extras) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, "priority");
    if (cJSON_IsNumber(item) && item->valuedouble >= -1e6 && item->valuedouble <= 1e6) {
        extras->has_priority = true;
        extras->priority = (int32_t)item->valuedouble;
    }
}

static void read_transform(const cJSON *object, EnfExtras *extras) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, "transform");
    if (!cJSON_IsArray(item) || cJSON_GetArraySize(item) != 16) {
        return;
    }
    double m[16];
    int i = 0;
    for (const cJSON *number = item->child; number != NULL; number = number->next, i++) {
        if (!cJSON_IsNumber(number)) {
            return;
        }
        m[i] = number->valuedouble;
    }
    for (int column = 0; column < 3; column++) {
        memcpy(&extras->transform.m[3 * column], &m[4 * column], 3 * sizeof m[0]);
    }
    extras->transform.t = enf_v3(m[12], m[13], m[14]);
    extras->has_transform = true;
}

EnfExtras enf_extras_read(const char *json) {
    EnfExtras extras = {.two_way = true, .active = true, .transform = {.m = {1, 0, 0, 0, 1, 0, 0, 0, 1}}};
    cJSON *object = json != NULL && json[0] == '{' ? cJSON_Parse(json) : NULL;
    if (object == NULL) {
        return extras;
    }
    read_priority(object, &extras);
    read_text(object, "portal_to", extras.portal_to);
    extras.makes_portal = extras.portal_to[0] != '\0';
    read_text(object, "to", extras.portal_to);
    read_text(object, "from", extras.from);
    read_text(object, "teleport_to", extras.teleport);
    read_text(object, "portal_to_portal", extras.teleport);
    read_text(object, "target", extras.teleport);
    read_text(object, "targetname", extras.targetname);
    extras.two_way = read_bool(object, "two_way", true);
    extras.active = read_bool(object, "active", true);
    extras.mirror = read_bool(object, "mirror", false);
    read_transform(object, &extras);
    cJSON_Delete(object);
    return extras;
}
