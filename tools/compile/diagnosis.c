/* EnfDiagnosis: the list of what the compiler found strange. Filled by every stage, printed by enfc, drawn by the overlay. */
#include "compile/diagnosis.h"

#include <stdio.h>
#include <string.h>

enum { MESSAGE_SIZE = 1024 };

static const char *const texts[ENF_DIAGNOSIS_COUNT] = {
#define ENF_DIAGNOSIS_TEXT(name, text, error) text,
    ENF_DIAGNOSES(ENF_DIAGNOSIS_TEXT)
#undef ENF_DIAGNOSIS_TEXT
};

static const bool errors[ENF_DIAGNOSIS_COUNT] = {
#define ENF_DIAGNOSIS_ERROR(name, text, error) error,
    ENF_DIAGNOSES(ENF_DIAGNOSIS_ERROR)
#undef ENF_DIAGNOSIS_ERROR
};

const char *enf_diagnosis_text(EnfDiagnosisCode code) {
    return (unsigned)code < ENF_DIAGNOSIS_COUNT ? texts[code] : "unknown";
}

bool enf_diagnosis_is_error(EnfDiagnosisCode code) {
    return (unsigned)code < ENF_DIAGNOSIS_COUNT && errors[code];
}

/* Copies `text`; NULL when memory is out. */
static char *copy_text(const char *text) {
    size_t length = strlen(text) + 1;
    char *copy = enf_alloc(NULL, length, 1);
    if (copy) {
        memcpy(copy, text, length);
    }
    return copy;
}

static void free_text(char *text) {
    if (text) {
        enf_free(NULL, text, strlen(text) + 1, 1);
    }
}

static bool reserve(EnfDiagnosis *diagnosis) {
    if (diagnosis->count < diagnosis->capacity) {
        return true;
    }
    uint32_t capacity = diagnosis->capacity ? diagnosis->capacity * 2 : 16;
    EnfFinding *grown = enf_realloc(NULL, diagnosis->findings, diagnosis->capacity, capacity, sizeof *grown);
    if (!grown) {
        return false;
    }
    diagnosis->findings = grown;
    diagnosis->capacity = capacity;
    return true;
}

void enf_diagnose(EnfDiagnosis *diagnosis, EnfDiagnosisCode code, const char *node, const char *format, ...) {
    if (!diagnosis || !reserve(diagnosis)) {
        return;
    }
    char message[MESSAGE_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    EnfFinding finding = {.code = code, .node = copy_text(node ? node : ""), .message = copy_text(message)};
    if (!finding.node || !finding.message) {
        free_text(finding.node);
        free_text(finding.message);
        return;
    }
    diagnosis->findings[diagnosis->count++] = finding;
}

void enf_diagnose_points(EnfDiagnosis *diagnosis, const EnfVec3 *points, uint32_t count) {
    if (!diagnosis || diagnosis->count == 0 || count == 0) {
        return;
    }
    EnfFinding *finding = &diagnosis->findings[diagnosis->count - 1];
    EnfVec3 *copy = enf_alloc(NULL, count, sizeof *copy);
    if (!copy) {
        return;
    }
    memcpy(copy, points, count * sizeof *copy);
    enf_free(NULL, finding->points, finding->point_count, sizeof *finding->points);
    finding->points = copy;
    finding->point_count = count;
}

void enf_diagnosis_free(EnfDiagnosis *diagnosis) {
    for (uint32_t i = 0; i < diagnosis->count; i++) {
        EnfFinding *finding = &diagnosis->findings[i];
        free_text(finding->node);
        free_text(finding->message);
        enf_free(NULL, finding->points, finding->point_count, sizeof *finding->points);
    }
    enf_free(NULL, diagnosis->findings, diagnosis->capacity, sizeof *diagnosis->findings);
    *diagnosis = (EnfDiagnosis){0};
}
