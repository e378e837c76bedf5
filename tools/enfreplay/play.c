/* Plays recordings: verify compares and nothing else, run also draws. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "common/png_file.h"
#include "common/report.h"
#include "enfreplay/enfreplay.h"
#include "enfreplay/watch.h"
#include "enfreplay/y4m.h"

/* ---- playing ---------------------------------------------------------------------------------------------------- */

/* A recording that is being played, and where what it shows goes. */
typedef struct Play {
    const Options *options;
    const char *recording;
    EnfReplay replay;
    Session session;
    Watch *watch;
    Y4m video;
    bool drawing;
    uint64_t ticks;    /* played */
    uint64_t diverged; /* ticks whose state differed */
    double seconds;
    uint64_t begun_ns;
} Play;

static uint64_t now_ns(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
}

/* Waits until the tick is due at --speed. */
static void keep_pace(const Play *play) {
    if (play->options->speed > 0.0) {
        double due = (double)play->ticks / ((double)play->replay.header.tick_rate * play->options->speed);
        uint64_t until = play->begun_ns + (uint64_t)(due * 1e9), now = now_ns();
        if (until > now) {
            struct timespec wait = {(time_t)((until - now) / 1000000000u), (long)((until - now) % 1000000000u)};
            nanosleep(&wait, NULL);
        }
    }
}

static EnfResult show(Play *play, uint64_t tick, EnfError *error) {
    const Options *o = play->options;
    const uint8_t *picture;
    bool draw = play->drawing && tick % o->every == 0;
    EnfResult result = play->watch ? watch_tick(play->watch, draw, &picture, error) : ENF_OK;
    if (result != ENF_OK || !draw) {
        return result;
    }
    if (o->frames) {
        char path[1024];
        int length = snprintf(path, sizeof path, "%s/%06" PRIu64 ".png", o->frames, tick);
        if (length < 0 || (size_t)length >= sizeof path) {
            return enf_error_set(error, ENF_ERROR_IO, UINT64_MAX, "the name of the folder is too long");
        }
        result = enf_png_write(path, picture, o->size[0], o->size[1], true, error);
    }
    return result == ENF_OK && o->video ? y4m_write(&play->video, picture, error) : result;
}

/* Plays to the end, or to the first tick whose state differs (on with --force). */
static EnfResult play_ticks(Play *play, EnfError *error) {
    const Options *o = play->options;
    EnfReplayCursor cursor = enf_replay_begin(&play->replay);
    const EnfReplayTick *tick;
    Progress progress = progress_begin(o);
    EnfResult result = ENF_OK;
    uint64_t total = o->ticks && o->ticks < play->replay.ticks ? o->ticks : play->replay.ticks;
    play->begun_ns = now_ns();
    while (play->ticks < total && result == ENF_OK && (tick = enf_replay_next(&cursor)) != NULL) {
        EnfReplayDivergence divergence;
        bool same = session_step(&play->session, &play->replay, tick, &divergence);
        if (!same && play->diverged++ == 0) {
            progress_end(&progress);
            session_tell(play->recording, &play->replay, &divergence);
        }
        if (!same && !o->force) {
            break;
        }
        result = show(play, tick->tick, error);
        play->ticks++;
        progress_tick(&progress, play->recording, play->ticks, total);
        keep_pace(play);
    }
    progress_end(&progress);
    play->seconds = (double)(now_ns() - play->begun_ns) * 1e-9;
    return result;
}

/* A start that differs shows before any tick. */
static bool starts_alike(const Play *play) {
    uint64_t hash = sim_hash(play->session.sim);
    if (hash == play->replay.header.start_hash) {
        return true;
    }
    fprintf(stderr,
            "enfreplay: %s: DIVERGED before the first tick: state %016" PRIx64 " was recorded, %016" PRIx64 " came of it\n",
            play->recording, play->replay.header.start_hash, hash);
    return false;
}

static EnfResult open_play(Play *play, EnfError *error) {
    const Options *o = play->options;
    EnfResult result = session_open(&play->session, &play->replay, o, play->recording, false, error);
    play->drawing = o->frames || o->video;
    if (result == ENF_OK && (play->drawing || o->dbv != DBV_OFF)) {
        result = watch_create(&play->watch, &play->session, o, error);
    }
    if (result == ENF_OK && o->frames && mkdir(o->frames, 0777) != 0) {
        struct stat status;
        if (stat(o->frames, &status) != 0 || !S_ISDIR(status.st_mode)) {
            result = enf_error_set(error, ENF_ERROR_IO, UINT64_MAX, "%.300s is no folder and cannot be made one", o->frames);
        }
    }
    if (result == ENF_OK && o->video) {
        result = y4m_open(&play->video, o->video, o->size, play->replay.header.tick_rate, o->every, error);
    }
    return result;
}

static void close_play(Play *play) {
    y4m_close(&play->video);
    watch_destroy(play->watch);
    session_close(&play->session);
    enf_replay_free(&play->replay);
}

/* Plays one recording; *played is left for whoever reports. Closed by the caller. */
static EnfResult play_one(Play *play, const Options *options, const char *recording, EnfError *error) {
    memset(play, 0, sizeof *play);
    play->options = options;
    play->recording = recording;
    EnfResult result = open_play(play, error);
    if (result != ENF_OK) {
        return result;
    }
    if (!starts_alike(play)) {
        play->diverged = 1;
        if (!options->force) {
            return ENF_OK;
        }
    }
    result = play_ticks(play, error);
    return result == ENF_OK && options->video ? y4m_finish(&play->video, error) : result;
}

/* ---- commands --------------------------------------------------------------------------------------------------- */

static EnfResult save_stats(const Play *play, EnfError *error) {
    EnfReport report = {.pretty = true};
    enf_report_object(&report, NULL);
    enf_report_text(&report, "recording", play->recording);
    enf_report_text(&report, "map", play->session.map_path);
    enf_report_count(&report, "ticks", play->ticks);
    enf_report_count(&report, "diverged", play->diverged);
    enf_report_number(&report, "seconds", play->seconds);
    enf_report_number(&report, "ticks_per_second", play->seconds > 0.0 ? (double)play->ticks / play->seconds : 0.0);
    if (play->watch) {
        WatchCounts counts = watch_counts(play->watch);
        enf_report_count(&report, "views", counts.views);
        enf_report_count(&report, "cells", counts.cells);
        enf_report_count(&report, "clusters", counts.clusters);
        enf_report_count(&report, "objects", counts.objects);
        enf_report_count(&report, "pictures", counts.pictures);
        enf_report_count(&report, "exposed", counts.exposed);
        enf_report_count(&report, "expired", counts.expired);
        enf_report_count(&report, "late", counts.late);
        enf_report_count(&report, "avoided", counts.avoided);
    }
    enf_report_end_object(&report);
    EnfResult result = enf_report_save(&report, play->options->stats, error);
    enf_report_free(&report);
    return result;
}

static void print_end(const Play *play) {
    char how[160];
    sim_describe(play->session.sim, how);
    fprintf(stderr, "%s: %" PRIu64 " ticks (%.1f s) in %.2f s, state %016" PRIx64 ", %s%s\n", play->recording, play->ticks,
            (double)play->ticks / (double)play->replay.header.tick_rate, play->seconds, sim_hash(play->session.sim), how,
            play->diverged ? "; DIVERGED" : "");
}

int cmd_run(const Options *options) {
    static Play play;
    EnfError error = {0};
    EnfResult result = play_one(&play, options, options->files[0], &error);
    if (result == ENF_OK && !options->quiet) {
        print_end(&play);
    }
    if (result == ENF_OK && options->stats) {
        result = save_stats(&play, &error);
    }
    bool differed = play.diverged > 0;
    close_play(&play);
    return result != ENF_OK ? enfreplay_fail(&error) : differed ? ENF_EXIT_FAILURE : ENF_EXIT_OK;
}

int cmd_verify(const Options *options) {
    static Play play;
    uint32_t failed = 0;
    for (uint32_t i = 0; i < options->file_count; i++) {
        EnfError error = {0};
        EnfResult result = play_one(&play, options, options->files[i], &error);
        if (result != ENF_OK) {
            enfreplay_fail(&error);
        } else if (play.diverged == 0 && !options->quiet) {
            char how[160];
            sim_describe(play.session.sim, how);
            printf("%s: ok, %" PRIu64 " ticks, state %016" PRIx64 ", %s\n", options->files[i], play.ticks,
                   sim_hash(play.session.sim), how);
        }
        failed += result != ENF_OK || play.diverged > 0;
        close_play(&play);
    }
    if (options->file_count > 1 && !options->quiet) {
        printf("%u recordings, %u of them differ or failed\n", options->file_count, failed);
    }
    return failed ? ENF_EXIT_FAILURE : ENF_EXIT_OK;
}
