/* Makes recordings: from scripts, from paths, from random input, and from the input of older recordings. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "enfreplay/enfreplay.h"
#include "enfreplay/mash.h"
#include "enfreplay/script.h"
#include "enfreplay/steer.h"

enum { MASH_TICKS = 3600, SCRIPT_BYTES_MAX = 1 << 20 };

/* Where input comes from. */
typedef enum SourceKind { SOURCE_SCRIPT, SOURCE_BOT, SOURCE_MASH, SOURCE_PATH, SOURCE_REPLAY } SourceKind;
typedef struct Source {
    SourceKind kind;
    uint64_t limit; /* ticks, UINT64_MAX for none */
    Script script;
    SimBot *bot;
    Mash mash;
    Steer steer;
    EnfReplayCursor cursor;
    const Session *session;
} Source;

/* ---- sources ---------------------------------------------------------------------------------------------------- */

/* The input of `tick`; false at the end, or with *result where a bot is at its wits' end. */
static bool source_next(Source *source, uint64_t tick, EnfInput *input, EnfResult *result, EnfError *error) {
    if (tick >= source->limit) {
        return false;
    }
    switch (source->kind) {
    case SOURCE_SCRIPT:
        if (tick < source->script.count) {
            *input = source->script.inputs[tick];
            return true;
        }
        return false;
    case SOURCE_BOT:
        return sim_bot_next(source->bot, input, result, error);
    case SOURCE_MASH:
        *input = mash_next(&source->mash);
        return true;
    case SOURCE_PATH: {
        SimEye eye = sim_eye(source->session->sim);
        if (sim_is_over(source->session->sim)) {
            return false;
        }
        if (steer_next(&source->steer, &eye, input)) {
            return true;
        }
        source->steer.next = 0; /* with --ticks it goes on from the beginning */
        return source->limit != UINT64_MAX && steer_next(&source->steer, &eye, input);
    }
    case SOURCE_REPLAY: {
        const EnfReplayTick *recorded = enf_replay_next(&source->cursor);
        *input = recorded ? recorded->input : *input;
        return recorded != NULL;
    }
    }
    return false;
}

static void source_close(Source *source) {
    script_free(&source->script);
    sim_bot_destroy(source->bot);
    steer_close(&source->steer);
}

bool enfreplay_number(const char *text, uint64_t *value) {
    char *end;
    errno = 0;
    unsigned long long parsed = strtoull(text, &end, 0);
    *value = parsed;
    return *text >= '0' && *text <= '9' && *end == '\0' && errno == 0;
}

static EnfResult open_script(Source *source, Session *session, const char *path, EnfError *error) {
    EnfFile file;
    EnfResult result = enf_file_read(&file, path, SCRIPT_BYTES_MAX, NULL, error);
    if (result != ENF_OK) {
        return result;
    }
    const char *text = (const char *)file.data;
    if (sim_bot_is_script(text, file.size)) {
        source->kind = SOURCE_BOT;
        result = sim_bot_create(&source->bot, session->sim, text, file.size, error);
    } else {
        source->kind = SOURCE_SCRIPT;
        result = script_parse(&source->script, text, file.size, error);
    }
    enf_file_free(&file);
    return result == ENF_OK ? ENF_OK : enf_error_file(error, result, path);
}

static EnfResult open_source(Source *source, Session *session, const Options *options, EnfError *error) {
    source->limit = options->ticks ? options->ticks : UINT64_MAX;
    if (options->script) {
        return open_script(source, session, options->script, error);
    }
    if (options->path) {
        source->kind = SOURCE_PATH;
        source->session = session;
        EnfResult result = steer_open(&source->steer, options->path, error);
        source->steer.run = options->run;
        source->steer.fly = options->fly;
        source->steer.use = options->use;
        return result;
    }
    uint64_t seed = 0;
    (void)enfreplay_number(options->mash, &seed); /* the command line was checked */
    source->kind = SOURCE_MASH;
    source->mash = mash_begin(seed, options->builder);
    source->limit = options->ticks ? options->ticks : MASH_TICKS;
    return ENF_OK;
}

/* ---- recording -------------------------------------------------------------------------------------------------- */

/* Plays the source to its end and records it. */
static EnfResult record_all(Session *session, Source *source, EnfRecorder *recorder, const Options *options, EnfError *error) {
    Progress progress = progress_begin(options);
    EnfInput input = {0, 0, 0, 0, 0};
    EnfResult result = ENF_OK;
    uint64_t total = source->kind == SOURCE_SCRIPT ? source->script.count : source->kind == SOURCE_MASH ? source->limit : 0;
    for (uint64_t tick = 0; result == ENF_OK && source_next(source, tick, &input, &result, error); tick++) {
        sim_step(session->sim, &input);
        result = sim_record(session->sim, recorder, &input, error);
        progress_tick(&progress, "recording", tick, total);
    }
    progress_end(&progress);
    return result == ENF_OK ? enf_recorder_finish(recorder, error) : result;
}

static EnfResult record_to(Session *session, Source *source, const EnfReplayHeader *header, const char *path,
                           const Options *options, EnfError *error) {
    EnfRecorder *recorder;
    EnfResult result = enf_recorder_create(&recorder, header, path, NULL, error);
    if (result != ENF_OK) {
        return result;
    }
    result = record_all(session, source, recorder, options, error);
    uint64_t ticks = enf_recorder_ticks(recorder);
    enf_recorder_destroy(recorder);
    if (result == ENF_OK && !options->quiet) {
        char how[160];
        sim_describe(session->sim, how);
        printf("%s: %llu ticks, %.1f s, state %016llx, %s\n", path, (unsigned long long)ticks,
               (double)ticks / (double)header->tick_rate, (unsigned long long)sim_hash(session->sim), how);
        if (source->kind == SOURCE_PATH && source->steer.given_up > 0) {
            printf("%s: %u of %u rows of the path could not be reached\n", path, source->steer.given_up,
                   source->steer.path.count);
        }
    }
    return result;
}

static void wanted_header(EnfReplayHeader *header, const Options *options, const Session *session) {
    *header = enf_replay_header_default();
    header->seed = 1;
    header->field_every = options->fields_every;
    if (options->seed) {
        (void)enfreplay_number(options->seed, &header->seed); /* the command line was checked */
    }
    const char *file = options->script ? options->script : options->path, *slash = file ? strrchr(file, '/') : NULL;
    char source[64];
    snprintf(source, sizeof source, "mash %.40s%s", options->mash ? options->mash : "", options->builder ? " builder" : "");
    snprintf(header->map, sizeof header->map, "%s", session->map_name);
    snprintf(header->start, sizeof header->start, "%s", options->start ? options->start : "");
    snprintf(header->title, sizeof header->title, "%s", options->title ? options->title : "");
    snprintf(header->script, sizeof header->script, "%s", slash ? slash + 1 : file ? file : source);
}

int cmd_record(const Options *options) {
    EnfError error = {0};
    Session session;
    Source source;
    EnfReplayHeader header = enf_replay_header_default();
    memset(&source, 0, sizeof source);
    EnfResult result = session_open_map(&session, options, "", &header, &error);
    wanted_header(&header, options, &session);
    if (result == ENF_OK && (result = session_start(&session, &header, &error)) == ENF_OK &&
        (result = open_source(&source, &session, options, &error)) == ENF_OK) {
        sim_fill_header(session.sim, &header);
        result = record_to(&session, &source, &header, options->output, options, &error);
    }
    source_close(&source);
    session_close(&session);
    return result == ENF_OK ? ENF_EXIT_OK : enfreplay_fail(&error);
}

/* ---- update ----------------------------------------------------------------------------------------------------- */

/* A slip of --map must not cost a recording: a map of another name is a map that was not meant, unless --force says so. */
static EnfResult check_name(const char *path, const Options *options, const Session *session, const EnfReplay *replay,
                            EnfError *error) {
    if (!options->map || options->force || strcmp(session->map_name, replay->header.map) == 0) {
        return ENF_OK;
    }
    enf_error_set(error, ENF_ERROR_ARGUMENT, UINT64_MAX, "recorded on the map %s, not on %s: --force moves it there",
                  replay->header.map, session->map_name);
    return enf_error_file(error, ENF_ERROR_ARGUMENT, path);
}

static EnfResult update_one(const char *path, const Options *options, EnfError *error) {
    Session session;
    EnfReplay replay;
    EnfResult result = session_open(&session, &replay, options, path, true, error);
    result = result ? result : check_name(path, options, &session, &replay, error);
    if (result == ENF_OK) {
        Source source;
        memset(&source, 0, sizeof source);
        source.kind = SOURCE_REPLAY;
        source.limit = UINT64_MAX;
        source.cursor = enf_replay_begin(&replay);
        EnfReplayHeader header = replay.header;
        snprintf(header.map, sizeof header.map, "%s", options->map ? session.map_name : replay.header.map);
        sim_fill_header(session.sim, &header);
        result = record_to(&session, &source, &header, path, options, error);
    }
    session_close(&session);
    enf_replay_free(&replay);
    return result;
}

int cmd_update(const Options *options) {
    int status = ENF_EXIT_OK;
    for (uint32_t i = 0; i < options->file_count; i++) {
        EnfError error = {0};
        if (update_one(options->files[i], options, &error) != ENF_OK) {
            status = enfreplay_fail(&error);
        }
    }
    return status;
}
