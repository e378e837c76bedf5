/* Settings by name: the project files that change them, and their part in the identity of a map. */
#include "compile/project.h"
#include "compile/json.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- the table -------------------------------------------------------------------------------------------------- */

typedef enum SettingKind { SETTING_NUMBER, SETTING_COUNT, SETTING_FLAG } SettingKind;

/* A setting: its key in a project, its place, and what it may be. */
typedef struct Setting {
    const char *key;
    SettingKind kind;
    size_t at, size;
    double least, most;
} Setting;

#define SETTING(field, kind, least, most)                                                                                      \
    { #field, kind, offsetof(EnfCompileSettings, field), sizeof((EnfCompileSettings){0}).field, least, most }
static const Setting settings_table[] = {
    SETTING(leak_gap, SETTING_NUMBER, 0.001, 100), SETTING(portal_snap, SETTING_NUMBER, 0, 10),
    SETTING(crease_deg, SETTING_NUMBER, 0, 180),   SETTING(max_image, SETTING_COUNT, 1, 16384),
    SETTING(weld_tjunctions, SETTING_FLAG, 0, 1),  SETTING(detect_leaks, SETTING_FLAG, 0, 1),
};
enum { SETTING_TOTAL = sizeof settings_table / sizeof *settings_table };

uint64_t enf_settings_hash(const EnfCompileSettings *settings) {
    EnfCompileSettings standard = enf_compile_settings_default();
    uint64_t hash = 0;
    for (int i = 0; i < SETTING_TOTAL; i++) {
        const Setting *s = &settings_table[i];
        const char *value = (const char *)settings + s->at;
        if (memcmp(value, (const char *)&standard + s->at, s->size) != 0) {
            hash = hash ? hash : ENF_HASH_START;
            hash = enf_hash64(hash, s->key, strlen(s->key));
            hash = enf_hash64(hash, value, s->size);
        }
    }
    return hash;
}

/* ---- reading ---------------------------------------------------------------------------------------------------- */

typedef struct Reader {
    EnfLevelProject *project;
    EnfJson json;
    const char *path;
    EnfError *error;
} Reader;

/* Relative paths of a project file start at its folder. */
static char *resolve(const char *project_path, const char *text) {
    const char *slash = strrchr(project_path, '/');
    size_t folder = text[0] != '/' && slash ? (size_t)(slash - project_path) + 1 : 0;
    size_t length = strlen(text);
    char *path = malloc(folder + length + 1);
    if (path) {
        memcpy(path, project_path, folder);
        memcpy(path + folder, text, length + 1);
    }
    return path;
}

static EnfResult read_path(const Reader *reader, uint32_t value, const char *key, char **path) {
    char text[4096];
    const EnfJsonValue *v = &reader->json.values[value];
    size_t length = v->type == ENF_JSON_STRING ? enf_json_string(&reader->json, value, text, sizeof text) : SIZE_MAX;
    if (length == 0 || length == SIZE_MAX || strlen(text) != length) {
        return enf_error_set(reader->error, ENF_ERROR_RANGE, v->start, "\"%s\" must be a path", key);
    }
    free(*path);
    *path = resolve(reader->path, text);
    return *path ? ENF_OK : enf_error_set(reader->error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory");
}

static EnfResult read_setting(const Reader *reader, const Setting *setting, uint32_t value) {
    const EnfJsonValue *v = &reader->json.values[value];
    char *to = (char *)&reader->project->settings + setting->at;
    if (setting->kind == SETTING_FLAG) {
        bool flag = v->type == ENF_JSON_TRUE;
        memcpy(to, &flag, sizeof flag);
        return flag || v->type == ENF_JSON_FALSE
                   ? ENF_OK
                   : enf_error_set(reader->error, ENF_ERROR_RANGE, v->start, "\"%s\" must be true or false", setting->key);
    }
    double number = 0;
    bool ok = enf_json_number(&reader->json, value, &number) && number >= setting->least && number <= setting->most;
    uint32_t count = ok ? (uint32_t)number : 0;
    if (!ok || (setting->kind == SETTING_COUNT && (double)count != number)) {
        return enf_error_set(reader->error, ENF_ERROR_RANGE, v->start, "\"%s\" must be %s in %g..%g", setting->key,
                             setting->kind == SETTING_COUNT ? "a whole number" : "a number", setting->least, setting->most);
    }
    memcpy(to, setting->kind == SETTING_COUNT ? (const void *)&count : (const void *)&number, setting->size);
    return ENF_OK;
}

static void warn_unknown(const Reader *reader, uint32_t key, const char *where) {
    char name[128] = "?";
    enf_json_string(&reader->json, key, name, sizeof name);
    EnfLevelProject *project = reader->project;
    char *text = project->warning_count < ENF_PROJECT_WARNINGS ? malloc(256) : NULL;
    if (text) {
        snprintf(text, 256, "unknown key \"%s\"%s is ignored", name, where);
        project->warnings[project->warning_count++] = text;
    }
}

static EnfResult read_settings(const Reader *reader, uint32_t object) {
    const EnfJson *json = &reader->json;
    if (json->values[object].type != ENF_JSON_OBJECT) {
        return enf_error_set(reader->error, ENF_ERROR_FORMAT, json->values[object].start, "\"settings\" must be an object");
    }
    EnfResult result = ENF_OK;
    for (uint32_t key = object + 1; key < json->values[object].next && result == ENF_OK;) {
        uint32_t value = json->values[key].next;
        int i = 0;
        while (i < SETTING_TOTAL && !enf_json_equals(json, key, settings_table[i].key)) {
            i++;
        }
        if (i < SETTING_TOTAL) {
            result = read_setting(reader, &settings_table[i], value);
        } else {
            warn_unknown(reader, key, " of \"settings\"");
        }
        key = json->values[value].next;
    }
    return result;
}

static EnfResult read_members(const Reader *reader) {
    const EnfJson *json = &reader->json;
    if (json->values[0].type != ENF_JSON_OBJECT) {
        return enf_error_set(reader->error, ENF_ERROR_FORMAT, 0, "a project is an object: {\"source\": …}");
    }
    EnfResult result = ENF_OK;
    for (uint32_t key = 1; key < json->values[0].next && result == ENF_OK;) {
        uint32_t value = json->values[key].next;
        if (enf_json_equals(json, key, "source")) {
            result = read_path(reader, value, "source", &reader->project->source);
        } else if (enf_json_equals(json, key, "output")) {
            result = read_path(reader, value, "output", &reader->project->output);
        } else if (enf_json_equals(json, key, "settings")) {
            result = read_settings(reader, value);
        } else {
            warn_unknown(reader, key, "");
        }
        key = json->values[value].next;
    }
    return result;
}

EnfResult enf_level_project_read(EnfLevelProject *project, const char *path, EnfError *error) {
    EnfFile file;
    memset(project, 0, sizeof *project);
    project->settings = enf_compile_settings_default();
    EnfResult result = enf_file_read(&file, path, ENF_PROJECT_SIZE_MAX, NULL, error);
    if (result != ENF_OK) {
        return result;
    }
    Reader reader = {project, {0}, path, error};
    result = enf_json_parse(&reader.json, (const char *)file.data, file.size, 0, error);
    if (result == ENF_OK) {
        result = read_members(&reader);
        enf_json_free(&reader.json);
    }
    enf_file_free(&file);
    if (result != ENF_OK) {
        enf_level_project_free(project);
        enf_error_file(error, result, path);
    }
    return result;
}

void enf_level_project_free(EnfLevelProject *project) {
    free(project->source);
    free(project->output);
    for (uint32_t i = 0; i < project->warning_count; i++) {
        free(project->warnings[i]);
    }
    memset(project, 0, sizeof *project);
}
