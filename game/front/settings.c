/* Makes Settings from JSON and back. The file may come from anybody: its size is bounded, and every value is checked. */
#include "front/settings.h"

#include <SDL.h>
#include <cJSON.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "common/report.h"

enum { FILE_MAX = 65536 };

static const char *const action_keys[ACTION_COUNT] = {
#define ACTION_KEY(name, key, label, code) key,
    SETTINGS_ACTIONS(ACTION_KEY)
#undef ACTION_KEY
};

Settings settings_default(void) {
    Settings s = {
#define NUMBER_DEFAULT(name, least, most, usual) .name = (usual),
        SETTINGS_NUMBERS(NUMBER_DEFAULT)
#undef NUMBER_DEFAULT
#define FLAG_DEFAULT(name, usual) .name = (usual),
            SETTINGS_FLAGS(FLAG_DEFAULT)
#undef FLAG_DEFAULT
                .keys =
            {
#define KEY_DEFAULT(name, key, label, code) (code),
                SETTINGS_ACTIONS(KEY_DEFAULT)
#undef KEY_DEFAULT
            },
    };
    return s;
}

/* Field by field: the structure has padding. */
bool settings_equal(const Settings *a, const Settings *b) {
    bool equal = memcmp(a->keys, b->keys, sizeof a->keys) == 0;
#define NUMBER_EQUAL(name, least, most, usual) equal = equal && fabs(a->name - b->name) <= 0.0;
    SETTINGS_NUMBERS(NUMBER_EQUAL)
#undef NUMBER_EQUAL
#define FLAG_EQUAL(name, usual) equal = equal && a->name == b->name;
    SETTINGS_FLAGS(FLAG_EQUAL)
#undef FLAG_EQUAL
    return equal;
}

const char *settings_action_label(Action action) {
    static const char *const labels[ACTION_COUNT] = {
#define ACTION_LABEL(name, key, label, code) label,
        SETTINGS_ACTIONS(ACTION_LABEL)
#undef ACTION_LABEL
    };
    return labels[action];
}

bool settings_find_path(char path[SETTINGS_PATH_SIZE]) {
    const char *config = getenv("XDG_CONFIG_HOME"), *home = getenv("HOME");
    int size = -1;
    if (config && *config == '/') {
        size = snprintf(path, SETTINGS_PATH_SIZE, "%s/enfilade/settings.json", config);
    } else if (home && *home) {
        size = snprintf(path, SETTINGS_PATH_SIZE, "%s/.config/enfilade/settings.json", home);
    }
    return size > 0 && size < SETTINGS_PATH_SIZE;
}

static void take_number(const cJSON *object, const char *key, const double range[2], double *value) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    if (cJSON_IsNumber(item) && isfinite(item->valuedouble)) {
        double v = item->valuedouble;
        *value = v < range[0] ? range[0] : v > range[1] ? range[1] : v;
    }
}

static void take_flag(const cJSON *object, const char *key, bool *value) {
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    if (cJSON_IsBool(item)) {
        *value = cJSON_IsTrue(item);
    }
}

static void take_keys(const cJSON *object, int keys[ACTION_COUNT]) {
    const cJSON *table = cJSON_GetObjectItemCaseSensitive(object, "keys");
    for (int i = 0; i < ACTION_COUNT; i++) {
        const cJSON *item = cJSON_IsObject(table) ? cJSON_GetObjectItemCaseSensitive(table, action_keys[i]) : NULL;
        if (cJSON_IsString(item) && item->valuestring) {
            SDL_Scancode code = SDL_GetScancodeFromName(item->valuestring);
            if (code != SDL_SCANCODE_UNKNOWN) {
                keys[i] = (int)code;
            }
        }
    }
}

static void take(Settings *s, const cJSON *object) {
#define TAKE_NUMBER(name, least, most, usual) take_number(object, #name, (const double[2]){(least), (most)}, &s->name);
    SETTINGS_NUMBERS(TAKE_NUMBER)
#undef TAKE_NUMBER
#define TAKE_FLAG(name, usual) take_flag(object, #name, &s->name);
    SETTINGS_FLAGS(TAKE_FLAG)
#undef TAKE_FLAG
    take_keys(object, s->keys);
}

EnfResult settings_read(Settings *settings, const char *path, EnfError *error) {
    *settings = settings_default();
    FILE *file = fopen(path, "rb");
    if (!file) {
        return errno == ENOENT || errno == ENOTDIR
                   ? ENF_OK
                   : enf_error_file(error, enf_error_set(error, ENF_ERROR_IO, UINT64_MAX, "%s", strerror(errno)), path);
    }
    char *text = enf_alloc(NULL, FILE_MAX + 1, 1);
    size_t size = text ? fread(text, 1, FILE_MAX + 1, file) : 0;
    bool failed = ferror(file) != 0;
    fclose(file);
    EnfResult result = ENF_OK;
    cJSON *root = NULL;
    if (!text || failed) {
        result = enf_error_set(error, text ? ENF_ERROR_IO : ENF_ERROR_MEMORY, UINT64_MAX, "the settings cannot be read");
    } else if (size > FILE_MAX) {
        result = enf_error_set(error, ENF_ERROR_SIZE, UINT64_MAX, "settings of more than %d bytes", FILE_MAX);
    } else {
        root = cJSON_ParseWithLength(text, size);
        if (cJSON_IsObject(root)) {
            take(settings, root);
        } else {
            result = enf_error_set(error, ENF_ERROR_FORMAT, UINT64_MAX, "the settings are no JSON object");
        }
    }
    cJSON_Delete(root);
    enf_free(NULL, text, FILE_MAX + 1, 1);
    return enf_error_file(error, result, path);
}

/* Makes the folders that lead to `path`, as far as they are missing. */
static void make_folders(const char *path) {
    char folder[SETTINGS_PATH_SIZE];
    snprintf(folder, sizeof folder, "%s", path);
    for (char *c = folder + 1; *c; c++) {
        if (*c == '/') {
            *c = '\0';
            mkdir(folder, 0755);
            *c = '/';
        }
    }
}

EnfResult settings_write(const Settings *s, const char *path, EnfError *error) {
    EnfReport report = {.pretty = true};
    enf_report_object(&report, NULL);
#define WRITE_NUMBER(name, least, most, usual) enf_report_number(&report, #name, s->name);
    SETTINGS_NUMBERS(WRITE_NUMBER)
#undef WRITE_NUMBER
#define WRITE_FLAG(name, usual) enf_report_bool(&report, #name, s->name);
    SETTINGS_FLAGS(WRITE_FLAG)
#undef WRITE_FLAG
    enf_report_object(&report, "keys");
    for (int i = 0; i < ACTION_COUNT; i++) {
        enf_report_text(&report, action_keys[i], SDL_GetScancodeName((SDL_Scancode)s->keys[i]));
    }
    enf_report_end_object(&report);
    enf_report_end_object(&report);
    make_folders(path);
    EnfResult result = enf_report_save(&report, path, error);
    enf_report_free(&report);
    return enf_error_file(error, result, path);
}
