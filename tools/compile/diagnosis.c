/* EnfDiagnosis: the list of what the compiler found strange, in the order in which the stages found it. */
#include "compile/diagnosis.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *text;
    bool is_error;
} catalogue[ENF_DIAGNOSIS_COUNT] = {
#define ENF_DIAGNOSIS_ROW(name, text, error) [ENF_DIAGNOSIS_##name] = {text, error},
    ENF_DIAGNOSES(ENF_DIAGNOSIS_ROW)
#undef ENF_DIAGNOSIS_ROW
};

const char *enf_diagnosis_text(EnfDiagnosisCode code) {
    return (unsigned)code < ENF_DIAGNOSIS_COUNT ? catalogue[code].text : "unknown";
}

bool enf_diagnosis_is_error(EnfDiagnosisCode code) {
    return (unsigned)code < ENF_DIAGNOSIS_COUNT && catalogue[code].is_error;
}

static char *copy_text(const char *text) {
    size_t size = strlen(text) + 1;
    char *copy = malloc(size);
    return copy ? memcpy(copy, text, size) : NULL;
}

static bool make_room(EnfDiagnosis *diagnosis) {
    if (diagnosis->count < diagnosis->capacity) {
        return true;
    }
    uint32_t capacity = diagnosis->capacity ? diagnosis->capacity * 2 : 16;
    EnfFinding *grown = realloc(diagnosis->findings, capacity * sizeof *grown);
    if (!grown) {
        return false;
    }
    diagnosis->findings = grown;
    diagnosis->capacity = capacity;
    return true;
}

void enf_diagnose(EnfDiagnosis *diagnosis, EnfDiagnosisCode code, const char *node, const char *format, ...) {
    char message[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    EnfFinding finding = {code, copy_text(node ? node : ""), copy_text(message), NULL, 0};
    if (!finding.node || !finding.message || !make_room(diagnosis)) {
        free(finding.node);
        free(finding.message);
        enf_log(ENF_LOG_WARNING, "%s: %s", enf_diagnosis_text(code), message);
        return;
    }
    diagnosis->findings[diagnosis->count++] = finding;
}

void enf_diagnose_points(EnfDiagnosis *diagnosis, const EnfVec3 *points, uint32_t count) {
    if (diagnosis->count == 0 || count == 0) {
        return;
    }
    EnfFinding *finding = &diagnosis->findings[diagnosis->count - 1];
    EnfVec3 *copy = malloc(count * sizeof *copy);
    if (!copy) {
        return;
    }
    free(finding->points);
    finding->points = memcpy(copy, points, count * sizeof *copy);
    finding->point_count = count;
}

void enf_diagnosis_free(EnfDiagnosis *diagnosis) {
    for (uint32_t i = 0; i < diagnosis->count; i++) {
        free(diagnosis->findings[i].node);
        free(diagnosis->findings[i].message);
        free(diagnosis->findings[i].points);
    }
    free(diagnosis->findings);
    memset(diagnosis, 0, sizeof *diagnosis);
}
