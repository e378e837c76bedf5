/* What enfc says: progress, findings, the summary for people and the report for programs. */
#ifndef ENFILADE_ENFC_SUMMARY_H
#define ENFILADE_ENFC_SUMMARY_H

#include "compile/compile.h"

/** An EnfProgressFn for a terminal: one line on stderr that is overwritten. */
void enfc_progress(void *user, const char *stage, double fraction);

/** A line on stderr for each finding: `warning: room-leak: node "Hall-room": …`. */
void enfc_print_findings(const EnfDiagnosis *diagnosis);

/** `error: FILE: at byte N: …` on stderr. */
void enfc_print_error(const EnfError *error);

/** Counts and times on stdout. */
void enfc_print_summary(const char *level, const char *output, const EnfCompileReport *report);

/** The report as JSON; `failure` is NULL or the error that ended the run, told under "error". */
EnfResult enfc_write_json(const char *path, const char *level, const EnfCompileReport *report, const EnfError *failure,
                          EnfError *error);

#endif
