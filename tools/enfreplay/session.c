/* Makes a session: the map that a recording was made on, found by name, and the game on it. */
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "enfreplay/enfreplay.h"

/* The last part of a path, without the ending ".enfmap". */
static void name_of(const char *path, char name[ENF_REPLAY_TEXT_SIZE]) {
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path;
    size_t length = strlen(base), ending = strlen(".enfmap");
    if (length > ending && strcmp(base + length - ending, ".enfmap") == 0) {
        length -= ending;
    }
    length = length < ENF_REPLAY_TEXT_SIZE ? length : ENF_REPLAY_TEXT_SIZE - 1;
    memcpy(name, base, length);
    name[length] = '\0';
}

/* Where the map of `header` should lie; false if the name cannot be one of a file. */
static bool map_path_of(char path[1024], const Options *options, const char *recording, const EnfReplayHeader *header) {
    const char *slash = strrchr(recording, '/');
    int length;
    if (!header->map[0] || strchr(header->map, '/') || header->map[0] == '.') {
        return false;
    }
    if (options->maps) {
        length = snprintf(path, 1024, "%s/%s.enfmap", options->maps, header->map);
    } else {
        length = snprintf(path, 1024, "%.*s%s.enfmap", slash ? (int)(slash - recording) + 1 : 0, recording, header->map);
    }
    return length > 0 && length < 1024;
}

EnfResult session_open_map(Session *session, const Options *options, const char *recording, const EnfReplayHeader *header,
                           EnfError *error) {
    memset(session, 0, sizeof *session);
    bool named = options->map ? snprintf(session->map_path, sizeof session->map_path, "%s", options->map) > 0
                              : map_path_of(session->map_path, options, recording, header);
    if (!named) {
        return enf_error_set(error, ENF_ERROR_ARGUMENT, UINT64_MAX, "the recording does not name its map: --map FILE.enfmap");
    }
    if (!options->map && access(session->map_path, R_OK) != 0) {
        return enf_error_set(error, ENF_ERROR_IO, UINT64_MAX,
                             "recorded on the map \"%s\", and there is no %.300s: compile it with enfc, or name it with --map "
                             "FILE or --maps FOLDER",
                             header->map, session->map_path);
    }
    name_of(options->map_name ? options->map_name : session->map_path, session->map_name);
    return enf_map_read(&session->map, session->map_path, NULL, error);
}

EnfResult session_start(Session *session, const EnfReplayHeader *header, EnfError *error) {
    sim_destroy(session->sim);
    session->sim = NULL;
    return sim_create(&session->sim, &session->map, header, error);
}

void session_close(Session *session) {
    sim_destroy(session->sim);
    enf_map_free(&session->map);
    memset(session, 0, sizeof *session);
}

EnfResult session_open(Session *session, EnfReplay *replay, const Options *options, const char *recording, bool any,
                       EnfError *error) {
    memset(session, 0, sizeof *session);
    EnfReplayMode mode = options->salvage ? ENF_REPLAY_SALVAGE : ENF_REPLAY_WHOLE;
    EnfResult result = enf_replay_read(replay, recording, mode, NULL, error);
    if (result != ENF_OK) {
        return result;
    }
    if (!replay->complete && !options->quiet) {
        fprintf(stderr, "enfreplay: %s: %s (byte %llu): the %llu ticks before are taken\n", recording, replay->damage.message,
                (unsigned long long)replay->damage.offset, (unsigned long long)replay->ticks);
    }
    if ((result = session_open_map(session, options, recording, &replay->header, error)) != ENF_OK) {
        return enf_error_file(error, result, recording);
    }
    if (!any && (result = enf_replay_accept(replay, sim_game(), session->map_path, session->map.hash, error)) != ENF_OK) {
        return enf_error_file(error, result, recording);
    }
    result = session_start(session, &replay->header, error);
    return result == ENF_OK ? ENF_OK : enf_error_file(error, result, recording);
}

bool session_step(Session *session, const EnfReplay *replay, const EnfReplayTick *tick, EnfReplayDivergence *divergence) {
    sim_step(session->sim, &tick->input);
    return sim_compare(session->sim, replay, tick, divergence);
}

/* ---- telling ---------------------------------------------------------------------------------------------------- */

void session_tell(const char *recording, const EnfReplay *replay, const EnfReplayDivergence *divergence) {
    const EnfReplayHeader *header = &replay->header;
    fprintf(stderr, "enfreplay: %s: DIVERGED at tick %llu (%.2f s): state %016llx was recorded, %016llx came of it\n",
            recording, (unsigned long long)divergence->tick, (double)divergence->tick / (double)header->tick_rate,
            (unsigned long long)divergence->recorded, (unsigned long long)divergence->replayed);
    if (!divergence->has_fields) {
        fprintf(stderr, "  the fields of this tick were not recorded (field-every %u)\n", header->field_every);
        return;
    }
    fprintf(stderr, "  fields that differ:");
    for (uint32_t i = 0; i < header->field_count; i++) {
        if (divergence->differing >> i & 1) {
            fprintf(stderr, " %s", header->fields[i]);
        }
    }
    fprintf(stderr, "%s\n", divergence->differing ? "" : " none that a 16-bit hash shows");
}

int enfreplay_fail(const EnfError *error) {
    fprintf(stderr, "enfreplay: %s%s%s", error->file, *error->file ? ": " : "",
            *error->message ? error->message : enf_result_text(error->code));
    if (error->offset != UINT64_MAX) {
        fprintf(stderr, " (byte %llu)", (unsigned long long)error->offset);
    }
    fprintf(stderr, "\n");
    return ENF_EXIT_FAILURE;
}

/* ---- progress --------------------------------------------------------------------------------------------------- */

enum { PROGRESS_TICKS = 600 };

Progress progress_begin(const Options *options) {
    Progress progress = {!options->quiet && isatty(STDERR_FILENO), 0};
    return progress;
}

void progress_tick(Progress *progress, const char *what, uint64_t tick, uint64_t total) {
    if (progress->on && tick >= progress->next) {
        progress->next = tick + PROGRESS_TICKS;
        fprintf(stderr, "\r%.60s: tick %llu of %llu ", what, (unsigned long long)tick, (unsigned long long)total);
    }
}

void progress_end(Progress *progress) {
    if (progress->on && progress->next > 0) {
        fprintf(stderr, "\r\033[K");
    }
}
