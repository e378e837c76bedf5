/* Reading extras of movers. A number may be written as text, a vector as "x,y,z" or as an array: Blender has both. */
#include "compile/mover_extras.h"

#include <cJSON.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Extras larger than this hold no level designer's keys. */
enum { EXTRAS_SEARCHED_MAX = 1 << 16 };
/* Numbers beyond this are slips of the keyboard, whatever their unit. */
#define NUMBER_MAX 1e6
/* Speeds below this (metres or degrees a second) are slips, too: a map holds floats, and 0 means that nothing is said. */
#define POSITIVE_MIN 1e-6

typedef struct Reader {
    const cJSON *object;
    const char *node;
    EnfDiagnosis *diagnosis;
} Reader;

static void complain(const Reader *reader, const char *key, const char *what) {
    if (reader->diagnosis) {
        enf_diagnose(reader->diagnosis, ENF_DIAGNOSIS_MOVER_KEY, reader->node, "'%s' %s", key, what);
    }
}

/* Up to `most` numbers of an array, of text with commas or blanks between, or of one number; 0 if that is not what is there. */
static uint32_t numbers_of(const cJSON *item, double *out, uint32_t most) {
    uint32_t count = 0;
    if (cJSON_IsNumber(item)) {
        out[count++] = item->valuedouble;
    } else if (cJSON_IsArray(item)) {
        for (const cJSON *n = item->child; n; n = n->next) {
            if (!cJSON_IsNumber(n) || count == most) {
                return 0;
            }
            out[count++] = n->valuedouble;
        }
    } else if (cJSON_IsString(item)) {
        const char *at = item->valuestring;
        for (char *end; *at; at = end + strspn(end, ", \t")) {
            double value = strtod(at, &end);
            if (end == at || count == most) {
                return 0;
            }
            out[count++] = value;
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        if (!(fabs(out[i]) <= NUMBER_MAX)) {
            return 0;
        }
    }
    return count;
}

static double read_number(const Reader *reader, const char *key, double standard) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(reader->object, key);
    double value;
    if (!item) {
        return standard;
    }
    if (numbers_of(item, &value, 1) != 1) {
        complain(reader, key, "is no number of a sensible size; it is not used");
        return standard;
    }
    return value;
}

static double read_positive(const Reader *reader, const char *key) {
    double value = read_number(reader, key, 0.0);
    if (value < 0.0) {
        complain(reader, key, "is negative; it is not used");
        return 0.0;
    }
    if (value > 0.0 && value < POSITIVE_MIN) {
        complain(reader, key, "is next to nothing; it is not used");
        return 0.0;
    }
    return value;
}

static bool read_vector(const Reader *reader, const char *key, EnfVec3 *out) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(reader->object, key);
    double v[3];
    if (!item) {
        return false;
    }
    if (numbers_of(item, v, 3) != 3 || v[0] * v[0] + v[1] * v[1] + v[2] * v[2] < 1e-12) {
        complain(reader, key, "is no vector \"x,y,z\" with a length; it is not used");
        return false;
    }
    *out = enf_v3(v[0], v[1], v[2]);
    return true;
}

/* A flag: true, 1, "1", "true", or (a key's name) any other text but "", "0" and "false". */
static bool read_flag(const Reader *reader, const char *key, bool standard) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(reader->object, key);
    if (cJSON_IsBool(item)) {
        return cJSON_IsTrue(item);
    }
    if (cJSON_IsNumber(item)) {
        return item->valuedouble < 0.0 || item->valuedouble > 0.0;
    }
    if (cJSON_IsString(item)) {
        const char *text = item->valuestring;
        return text[0] && strcmp(text, "0") != 0 && strcasecmp(text, "false") != 0;
    }
    return standard;
}

static void read_name(const Reader *reader, const char *key, char out[ENF_MOVER_NAME]) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(reader->object, key);
    if (cJSON_IsString(item) && strlen(item->valuestring) < ENF_MOVER_NAME) {
        strcpy(out, item->valuestring);
    } else if (item) {
        complain(reader, key, "is no text of at most 127 bytes; it is not used");
    }
}

/* A class that is given twice is one that somebody forgot. */
static void read_class(const Reader *reader, char out[ENF_MOVER_NAME]) {
    uint32_t given = 0;
    read_name(reader, "classname", out);
    for (const cJSON *item = reader->object->child; item; item = item->next) {
        given += item->string && strcmp(item->string, "classname") == 0;
    }
    if (given > 1) {
        complain(reader, "classname", "is given more than once: the first holds");
    }
}

static EnfWrap read_wrap(const Reader *reader) {
    static const char *const names[] = {"once", "loop", "pingpong"};
    char text[ENF_MOVER_NAME] = "";
    read_name(reader, "wrap", text);
    for (int i = 0; i < 3 && text[0]; i++) {
        if (strcasecmp(text, names[i]) == 0) {
            return (EnfWrap)i;
        }
    }
    if (text[0]) {
        complain(reader, "wrap", "is none of once, loop, pingpong; it is not used");
    }
    return ENF_WRAP_LOOP;
}

static void read_stops(const Reader *reader, EnfMoverExtras *extras) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(reader->object, "stops");
    if (item) {
        extras->stop_count = numbers_of(item, extras->stops, ENF_MOVER_STOPS);
        if (extras->stop_count < 2) {
            complain(reader, "stops", "are not 2 to 32 heights \"0,4.5,9\"; they are not used");
            extras->stop_count = 0;
        }
    }
}

EnfMoverExtras enf_mover_extras(const char *json, const char *node, EnfDiagnosis *diagnosis) {
    EnfMoverExtras extras;
    memset(&extras, 0, sizeof extras);
    extras.wrap = ENF_WRAP_LOOP;
    extras.solid = true;
    extras.axis = enf_v3(0.0, 1.0, 0.0);
    size_t length = strlen(json);
    cJSON *object = length > 0 && length <= EXTRAS_SEARCHED_MAX ? cJSON_ParseWithLength(json, length) : NULL;
    if (!object) {
        return extras;
    }
    Reader reader = {object, node, diagnosis};
    read_class(&reader, extras.classname);
    read_name(&reader, "portal", extras.portal);
    extras.wrap = read_wrap(&reader);
    extras.phase = read_number(&reader, "phase", 0.0);
    extras.validity = read_positive(&reader, "validity");
    extras.has_axis = read_vector(&reader, "axis", &extras.axis);
    extras.has_move = read_vector(&reader, "move", &extras.move);
    extras.angle = read_number(&reader, "angle", 0.0);
    extras.swing_low = read_number(&reader, "swing_low", 0.0);
    extras.speed = read_positive(&reader, "speed");
    extras.max_speed = read_positive(&reader, "max_speed");
    read_stops(&reader, &extras);
    extras.solid = read_flag(&reader, "solid", true);
    extras.locked = read_flag(&reader, "locked", false);
    extras.dynamic = read_flag(&reader, "dynamic", false) || extras.max_speed > 0.0;
    cJSON_Delete(object);
    return extras;
}

bool enf_mover_class(const char *classname) {
    static const char *const families[] = {"func_", "prop_", "item_", "npc_"};
    for (size_t i = 0; i < sizeof families / sizeof *families; i++) {
        if (strncmp(classname, families[i], strlen(families[i])) == 0) {
            return true;
        }
    }
    return false;
}
