/* Prints what a recording says of itself. */
#include <stdio.h>
#include <string.h>

#include "common/report.h"
#include "enfreplay/enfreplay.h"

static void print_line(const char *key, const char *value) {
    if (*value) {
        printf("  %-12s %s\n", key, value);
    }
}

/* How the input looks: ticks in which something was held or turned, and times that each button went down. */
typedef struct Habits {
    uint64_t moving, turning;
    uint64_t presses[32];
} Habits;

static Habits habits_of(const EnfReplay *replay) {
    Habits habits;
    memset(&habits, 0, sizeof habits);
    EnfReplayCursor cursor = enf_replay_begin(replay);
    const EnfReplayTick *tick;
    uint32_t held = 0;
    while ((tick = enf_replay_next(&cursor)) != NULL) {
        habits.moving += tick->input.forward || tick->input.right;
        habits.turning += tick->input.yaw || tick->input.pitch;
        for (unsigned bit = 0; bit < 32; bit++) {
            habits.presses[bit] += (tick->input.buttons & ~held) >> bit & 1;
        }
        held = tick->input.buttons;
    }
    return habits;
}

static void print_habits(const EnfReplay *replay) {
    static const char *const names[7] = {"jump", "crouch", "run", "use", "drop", "noclip", "fly"};
    Habits habits = habits_of(replay);
    printf("  %-12s %llu ticks walking, %llu turning; pressed:", "input", (unsigned long long)habits.moving,
           (unsigned long long)habits.turning);
    for (unsigned bit = 0; bit < 32; bit++) {
        if (habits.presses[bit] && bit < 7) {
            printf(" %s %llu", names[bit], (unsigned long long)habits.presses[bit]);
        } else if (habits.presses[bit]) {
            printf(" bit-%u %llu", bit, (unsigned long long)habits.presses[bit]);
        }
    }
    printf("\n");
}

static void print_text(const char *path, const EnfReplay *replay) {
    const EnfReplayHeader *header = &replay->header;
    double seconds = (double)replay->ticks / (double)header->tick_rate;
    printf("%s\n", path);
    print_line("title", header->title);
    print_line("engine", header->engine);
    print_line("game", header->game);
    printf("  %-12s %s (%016llx)\n", "map", header->map, (unsigned long long)header->map_hash);
    print_line("start", header->start);
    print_line("made from", header->script);
    printf("  %-12s %llu at %u a second: %d:%05.2f\n", "ticks", (unsigned long long)replay->ticks, header->tick_rate,
           (int)(seconds / 60.0), seconds - 60.0 * (double)(int)(seconds / 60.0));
    printf("  %-12s %016llx\n", "seed", (unsigned long long)header->seed);
    printf("  %-12s %016llx at the start, %016llx at the end\n", "state", (unsigned long long)header->start_hash,
           (unsigned long long)replay->final_hash);
    printf("  %-12s", "fields");
    for (uint32_t i = 0; i < header->field_count; i++) {
        printf(" %s", header->fields[i]);
    }
    printf(header->field_every > 1 ? " (at each %uth tick)\n" : "\n", header->field_every);
    print_habits(replay);
    printf("  %-12s %zu bytes, %.1f a tick\n", "size", replay->size,
           replay->ticks ? (double)replay->size / (double)replay->ticks : 0.0);
    if (!replay->complete) {
        printf("  %-12s %s (byte %llu)\n", "incomplete", replay->damage.message, (unsigned long long)replay->damage.offset);
    }
}

static void report_hash(EnfReport *report, const char *key, uint64_t hash) {
    char text[17];
    snprintf(text, sizeof text, "%016llx", (unsigned long long)hash);
    enf_report_text(report, key, text);
}

static EnfResult print_json(const char *path, const EnfReplay *replay, EnfError *error) {
    const EnfReplayHeader *header = &replay->header;
    EnfReport report = {0};
    enf_report_object(&report, NULL);
    enf_report_text(&report, "file", path);
    enf_report_text(&report, "title", header->title);
    enf_report_text(&report, "engine", header->engine);
    enf_report_text(&report, "game", header->game);
    enf_report_text(&report, "map", header->map);
    report_hash(&report, "map_hash", header->map_hash);
    enf_report_text(&report, "start", header->start);
    enf_report_text(&report, "script", header->script);
    enf_report_count(&report, "ticks", replay->ticks);
    enf_report_count(&report, "tick_rate", header->tick_rate);
    report_hash(&report, "seed", header->seed);
    report_hash(&report, "start_hash", header->start_hash);
    report_hash(&report, "final_hash", replay->final_hash);
    enf_report_count(&report, "field_every", header->field_every);
    enf_report_array(&report, "fields");
    for (uint32_t i = 0; i < header->field_count; i++) {
        enf_report_text(&report, NULL, header->fields[i]);
    }
    enf_report_end_array(&report);
    enf_report_count(&report, "bytes", replay->size);
    enf_report_bool(&report, "complete", replay->complete);
    enf_report_end_object(&report);
    EnfResult result = enf_report_save(&report, "-", error);
    enf_report_free(&report);
    return result;
}

int cmd_info(const Options *options) {
    int status = ENF_EXIT_OK;
    for (uint32_t i = 0; i < options->file_count; i++) {
        EnfError error = {0};
        EnfReplay replay;
        EnfReplayMode mode = options->salvage ? ENF_REPLAY_SALVAGE : ENF_REPLAY_WHOLE;
        EnfResult result = enf_replay_read(&replay, options->files[i], mode, NULL, &error);
        if (result == ENF_OK && options->json) {
            result = print_json(options->files[i], &replay, &error);
        } else if (result == ENF_OK) {
            print_text(options->files[i], &replay);
        }
        enf_replay_free(&replay);
        status = result == ENF_OK ? status : enfreplay_fail(&error);
    }
    return status;
}
