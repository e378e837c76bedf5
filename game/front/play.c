/* Makes a game go on, recorded or replayed. */
#include <stdio.h>
#include <string.h>

#include "front/app.h"
#include "sim/record.h"

/* As enfreplay names maps, so that it finds them beside a recording: the file's name without folder and ending. */
static void map_name(const char *path, char name[ENF_REPLAY_TEXT_SIZE]) {
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path, *dot = strrchr(base, '.');
    snprintf(name, ENF_REPLAY_TEXT_SIZE, "%.*s", dot && dot != base ? (int)(dot - base) : (int)strlen(base), base);
}

static EnfResult begin_recording(Play *play, const EnfMap *map, const Options *options, EnfError *error) {
    char name[ENF_REPLAY_TEXT_SIZE];
    map_name(options->map, name);
    EnfReplayHeader header = game_replay_header(play->game, &play->def, map, name);
    snprintf(header.title, sizeof header.title, "played");
    return enf_recorder_create(&play->recorder, &header, options->record, NULL, error);
}

static EnfResult begin_replay(Play *play, const EnfMap *map, const Options *options, EnfError *error) {
    char name[ENF_REPLAY_TEXT_SIZE];
    map_name(options->map, name);
    EnfResult result = enf_replay_read(&play->replay, options->play, ENF_REPLAY_WHOLE, NULL, error);
    result = result ? result : enf_replay_accept(&play->replay, GAME_NAME, name, map->hash, error);
    result = result ? result : game_def_from_header(&play->def, &play->replay.header, error);
    if (result == ENF_OK) {
        play->replays = true;
        play->cursor = enf_replay_begin(&play->replay);
    }
    return result ? enf_error_file(error, result, options->play) : ENF_OK;
}

EnfResult play_open(Play *play, const EnfMap *map, const Options *options, EnfError *error) {
    memset(play, 0, sizeof *play);
    play->def = game_def_default();
    play->def.seed = options->seed;
    EnfResult result = options->play ? begin_replay(play, map, options, error) : ENF_OK;
    result = result ? result : game_create(&play->game, map, &play->def, NULL, error);
    if (result == ENF_OK && options->record) {
        result = begin_recording(play, map, options, error);
    }
    return result;
}

void play_close(Play *play) {
    if (play->recorder) {
        play_finish(play, NULL);
    }
    enf_replay_free(&play->replay);
    game_destroy(play->game);
    memset(play, 0, sizeof *play);
}

static void replay_tick(Play *play) {
    const EnfReplayTick *tick = enf_replay_next(&play->cursor);
    if (!tick) {
        play->replay_ended = true;
        return;
    }
    game_step(play->game, &tick->input);
    if (!play->diverged && !game_compare(play->game, &play->replay, tick, &play->divergence)) {
        play->diverged = true;
    }
}

void play_step(Play *play, const EnfInput *input) {
    if (play->replays) {
        replay_tick(play);
        return;
    }
    GamePhase before = game_state(play->game)->phase;
    game_step(play->game, input);
    if (play->recorder && before == GAME_PLAYING) { /* what goes on behind the last menu is no one's doing */
        game_record(play->recorder, play->game, input, NULL);
    }
}

EnfResult play_finish(Play *play, EnfError *error) {
    bool empty = play->recorder && enf_recorder_ticks(play->recorder) == 0; /* nobody played: nothing is written */
    EnfResult result = play->recorder && !empty ? enf_recorder_finish(play->recorder, error) : ENF_OK;
    enf_recorder_destroy(play->recorder);
    play->recorder = NULL;
    return result;
}
