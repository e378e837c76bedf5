/* What enfc says; see summary.h. */
#include "enfc/summary.h"

#include "common/report.h"

#include <stdio.h>
#include <string.h>

/* Findings of one code beyond this many are counted, not printed; the JSON report has them all. */
enum { FINDINGS_PRINTED_MAX = 20, BAR_WIDTH = 24 };

void enfc_progress(void *user, const char *stage, double fraction) {
    (void)user;
    if (fraction >= 1) {
        fprintf(stderr, "\r%*s\r", BAR_WIDTH + 40, "");
        return;
    }
    char bar[BAR_WIDTH + 1];
    int full = (int)(fraction * BAR_WIDTH);
    memset(bar, '-', BAR_WIDTH);
    memset(bar, '#', (size_t)full);
    bar[BAR_WIDTH] = '\0';
    fprintf(stderr, "\r[%s] %3d %% %-24s", bar, (int)(fraction * 100), stage);
    fflush(stderr);
}

static const char *severity(EnfDiagnosisCode code) {
    return enf_diagnosis_is_error(code) ? "error" : "warning";
}

void enfc_print_findings(const EnfDiagnosis *diagnosis) {
    uint32_t printed[ENF_DIAGNOSIS_COUNT] = {0};
    for (uint32_t i = 0; i < diagnosis->count; i++) {
        const EnfFinding *finding = &diagnosis->findings[i];
        if (printed[finding->code]++ >= FINDINGS_PRINTED_MAX) {
            continue;
        }
        fprintf(stderr, "%s: %s: ", severity(finding->code), enf_diagnosis_text(finding->code));
        if (finding->node[0]) {
            fprintf(stderr, "node \"%s\": ", finding->node);
        }
        fprintf(stderr, "%s\n", finding->message);
    }
    for (int code = 0; code < ENF_DIAGNOSIS_COUNT; code++) {
        if (printed[code] > FINDINGS_PRINTED_MAX) {
            fprintf(stderr, "%s: %s: and %u more like this (--json lists them all)\n", severity((EnfDiagnosisCode)code),
                    enf_diagnosis_text((EnfDiagnosisCode)code), printed[code] - FINDINGS_PRINTED_MAX);
        }
    }
}

void enfc_print_error(const EnfError *error) {
    fprintf(stderr, "error: ");
    if (error->file[0]) {
        fprintf(stderr, "%s: ", error->file);
    }
    if (error->offset != UINT64_MAX) {
        fprintf(stderr, "at byte %llu: ", (unsigned long long)error->offset);
    }
    fprintf(stderr, "%s\n", error->message[0] ? error->message : enf_result_text(error->code));
}

/* ---- summary ---------------------------------------------------------------------------------------------------- */

static const char *bytes_text(uint64_t bytes, char out[32]) {
    if (bytes < 10240) {
        snprintf(out, 32, "%llu bytes", (unsigned long long)bytes);
    } else if (bytes < 10u << 20) {
        snprintf(out, 32, "%.1f KiB", (double)bytes / 1024);
    } else {
        snprintf(out, 32, "%.1f MiB", (double)bytes / 1048576);
    }
    return out;
}

static void count_line(const char *name, uint64_t count, const char *rest) {
    printf("  %-12s %9llu%s%s\n", name, (unsigned long long)count, *rest ? "   " : "", rest);
}

void enfc_print_summary(const char *level, const char *output, const EnfCompileReport *report) {
    char rest[96], size[32];
    double total = report->seconds_import + report->seconds_cells + report->seconds_kd + report->seconds_write;
    printf("%s -> %s\n", level, output);
    count_line("cells", report->cells, "");
    snprintf(rest, sizeof rest, "%u half-portals and links", report->half_portals);
    count_line("portals", report->portals, rest);
    snprintf(rest, sizeof rest, "%llu stored", (unsigned long long)report->triangles_stored);
    count_line("triangles", report->triangles, rest);
    count_line("clusters", report->clusters, "");
    count_line("kd nodes", report->kd_nodes, "");
    count_line("lights", report->lights, "");
    if (report->movers > 0) {
        snprintf(rest, sizeof rest, "%u meshes", report->meshes);
        count_line("movers", report->movers, rest);
    }
    count_line("warnings", report->diagnosis.count, "");
    printf("  %s in %.3f s: import %.3f, cells %.3f, kd %.3f, write %.3f\n", bytes_text(report->bytes, size), total,
           report->seconds_import, report->seconds_cells, report->seconds_kd, report->seconds_write);
}

/* ---- json ------------------------------------------------------------------------------------------------------- */

/* Seconds to the microsecond: more digits are noise. */
static void write_seconds(EnfReport *json, const char *key, double seconds) {
    enf_report_number(json, key, (double)(uint64_t)(seconds * 1e6 + 0.5) / 1e6);
}

static void write_counts(EnfReport *json, const EnfCompileReport *report) {
    enf_report_count(json, "cells", report->cells);
    enf_report_count(json, "portals", report->portals);
    enf_report_count(json, "half_portals", report->half_portals);
    enf_report_count(json, "triangles", report->triangles);
    enf_report_count(json, "triangles_stored", report->triangles_stored);
    enf_report_count(json, "clusters", report->clusters);
    enf_report_count(json, "kd_nodes", report->kd_nodes);
    enf_report_count(json, "lights", report->lights);
    enf_report_count(json, "movers", report->movers);
    enf_report_count(json, "meshes", report->meshes);
    enf_report_count(json, "bytes", report->bytes);
    enf_report_object(json, "seconds");
    write_seconds(json, "import", report->seconds_import);
    write_seconds(json, "cells", report->seconds_cells);
    write_seconds(json, "kd", report->seconds_kd);
    write_seconds(json, "write", report->seconds_write);
    enf_report_end_object(json);
}

static void write_findings(EnfReport *json, const EnfDiagnosis *diagnosis) {
    enf_report_array(json, "warnings");
    for (uint32_t i = 0; i < diagnosis->count; i++) {
        const EnfFinding *finding = &diagnosis->findings[i];
        enf_report_object(json, NULL);
        enf_report_text(json, "code", enf_diagnosis_text(finding->code));
        enf_report_text(json, "severity", severity(finding->code));
        enf_report_text(json, "node", finding->node);
        enf_report_text(json, "message", finding->message);
        if (finding->point_count > 0) {
            const double p[3] = {finding->points[0].x, finding->points[0].y, finding->points[0].z};
            enf_report_array(json, "place");
            for (int axis = 0; axis < 3; axis++) {
                enf_report_number(json, NULL, p[axis]);
            }
            enf_report_end_array(json);
        }
        enf_report_end_object(json);
    }
    enf_report_end_array(json);
}

EnfResult enfc_write_json(const char *path, const char *level, const EnfCompileReport *report, const EnfError *failure,
                          EnfError *error) {
    EnfReport json;
    memset(&json, 0, sizeof json);
    json.pretty = true;
    enf_report_object(&json, NULL);
    enf_report_text(&json, "level", level);
    enf_report_bool(&json, "ok", failure == NULL);
    write_counts(&json, report);
    if (failure) {
        enf_report_object(&json, "error");
        enf_report_text(&json, "code", enf_result_text(failure->code));
        enf_report_text(&json, "message", failure->message);
        enf_report_text(&json, "file", failure->file);
        if (failure->offset != UINT64_MAX) {
            enf_report_count(&json, "offset", failure->offset);
        }
        enf_report_end_object(&json);
    }
    write_findings(&json, &report->diagnosis);
    enf_report_end_object(&json);
    EnfResult result = enf_report_save(&json, path, error);
    enf_report_free(&json);
    return result;
}
