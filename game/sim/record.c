/* The game's side of a recording. */
#include "sim/record.h"

#include <stdio.h>
#include <string.h>

/* ---- header ----------------------------------------------------------------------------------------------------- */

static void copy_text(char *to, size_t size, const char *from) {
    memset(to, 0, size);
    snprintf(to, size, "%s", from);
}

EnfReplayHeader game_replay_header(const Game *game, const GameDef *def, const EnfMap *map, const char *map_name) {
    EnfReplayHeader header = enf_replay_header_default();
    GameField fields[GAME_FIELDS_MAX];
    copy_text(header.game, sizeof header.game, GAME_NAME);
    copy_text(header.map, sizeof header.map, map_name);
    snprintf(header.start, sizeof header.start, "exhibits=%lu%s", (unsigned long)def->exhibits_wanted,
             def->peaceful ? " peaceful" : "");
    header.map_hash = map->hash;
    header.seed = def->seed;
    header.start_hash = game_hash(game);
    header.tick_rate = ENF_TICK_RATE;
    header.field_count = game_fields(game, fields);
    for (uint32_t i = 0; i < header.field_count; i++) {
        copy_text(header.fields[i], sizeof header.fields[i], fields[i].name);
    }
    return header;
}

/* The digits at *text, moved past; false if there is none, or if they are too many for 32 bits. */
static bool take_count(const char **text, uint32_t *count) {
    uint64_t value = 0;
    const char *at = *text;
    while (*at >= '0' && *at <= '9' && value <= UINT32_MAX) {
        value = value * 10 + (uint64_t)(*at++ - '0');
    }
    bool taken = at != *text && value <= UINT32_MAX;
    *text = at;
    *count = (uint32_t)value;
    return taken;
}

EnfResult game_def_from_header(GameDef *def, const EnfReplayHeader *header, EnfError *error) {
    static const char exhibits[] = "exhibits=", peaceful[] = "peaceful";
    const char *at = header->start;
    *def = game_def_default();
    def->seed = header->seed;
    while (*at) {
        if (strncmp(at, exhibits, sizeof exhibits - 1) == 0) {
            at += sizeof exhibits - 1;
            if (!take_count(&at, &def->exhibits_wanted)) {
                break;
            }
        } else if (strncmp(at, peaceful, sizeof peaceful - 1) == 0) {
            at += sizeof peaceful - 1;
            def->peaceful = true;
        } else {
            break;
        }
        if (*at && *at++ != ' ') {
            break;
        }
    }
    if (*at) {
        return enf_error_set(error, ENF_ERROR_FORMAT, UINT64_MAX,
                             "the game cannot start as \"%.200s\": it knows exhibits=N and peaceful", header->start);
    }
    return ENF_OK;
}

/* ---- ticks ------------------------------------------------------------------------------------------------------ */

static void field_hashes(const Game *game, uint64_t hashes[ENF_REPLAY_FIELDS_MAX]) {
    GameField fields[GAME_FIELDS_MAX];
    uint32_t count = game_fields(game, fields);
    for (uint32_t i = 0; i < count; i++) {
        hashes[i] = fields[i].hash;
    }
}

EnfResult game_record(EnfRecorder *recorder, const Game *game, const EnfInput *input, EnfError *error) {
    uint64_t hashes[ENF_REPLAY_FIELDS_MAX];
    field_hashes(game, hashes);
    return enf_recorder_tick(recorder, input, game_hash(game), hashes, error);
}

bool game_compare(const Game *game, const EnfReplay *replay, const EnfReplayTick *tick, EnfReplayDivergence *divergence) {
    uint64_t hashes[ENF_REPLAY_FIELDS_MAX], hash = game_hash(game);
    GameField fields[GAME_FIELDS_MAX];
    if (hash == tick->hash) {
        return true;
    }
    bool same_names = game_fields(game, fields) == replay->header.field_count;
    for (uint32_t i = 0; same_names && i < replay->header.field_count; i++) {
        same_names = strcmp(fields[i].name, replay->header.fields[i]) == 0;
    }
    field_hashes(game, hashes);
    return enf_replay_compare(replay, tick, hash, same_names ? hashes : NULL, divergence);
}
