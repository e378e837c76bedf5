/* Makes Options from the command line, and refuses what makes no sense together. */
#include <math.h>

#include "front/app.h"

static const char about[] =
    "A night at the palace: find exhibits and carry them out past the guards. Any other compiled level can be walked.\n"
    "Without --map it opens build/demo/palace.enfmap, which tools/run demo makes. Esc is the menu, where the keys are; F1 "
    "tells\n"
    "what the engine does. --record writes what you do as a recording that enfreplay verifies; --play shows one.\n"
    "Exit status: 0, 1 if something failed (with --play: or a tick differed), 2 for a wrong command line.";

/* Why this cannot be meant, or NULL: what was asked for is never left out silently. */
static const char *nonsense(const Options *o) {
    return o->record && o->play                ? "--record and --play exclude each other"
           : o->tour && (o->record || o->play) ? "--tour is neither recorded nor played from a recording"
           : o->headless && o->record          ? "--record needs a window; enfreplay record makes recordings without one"
           : o->headless && o->fullscreen      ? "--headless and --fullscreen exclude each other"
           : o->headless && !o->play && !o->tour && !o->shot ? "--headless needs --play FILE, --tour or --shot OUT.png"
           : o->stats && !(o->headless && o->tour)           ? "--stats goes with --headless --tour"
           : o->shot && !o->headless && !o->frames           ? "--shot needs --frames N: after which frame (or --headless)"
                                                             : NULL;
}

EnfCliResult options_parse(Options *o, int argc, char **argv) {
    double seed = 1.0;
    o->speed = 1.0;
    const EnfOption options[] = {
        {"--map", "-m", ENF_OPTION_TEXT, &o->map, "MAP.enfmap", NULL, "the level (the palace)"},
        {"--record", NULL, ENF_OPTION_TEXT, &o->record, "FILE", NULL, "record the game (.enfreplay)"},
        {"--play", NULL, ENF_OPTION_TEXT, &o->play, "FILE", NULL, "show a recording"},
        {"--speed", NULL, ENF_OPTION_NUMBER, &o->speed, "X", NULL, "of --play, times as fast (1)"},
        {"--headless", NULL, ENF_OPTION_FLAG, &o->headless, NULL, NULL, "no window; with --play, --tour or --shot"},
        {"--tour", NULL, ENF_OPTION_FLAG, &o->tour, NULL, NULL, "the guided tour at once"},
        {"--stats", NULL, ENF_OPTION_FLAG, &o->stats, NULL, NULL, "with --headless --tour: frame rates, culled and not"},
        {"--frames", NULL, ENF_OPTION_COUNT, &o->frames, "N", NULL, "quit after N frames; without a window: ticks of the game"},
        {"--shot", NULL, ENF_OPTION_TEXT, &o->shot, "OUT.png", NULL, "write the last of --frames, or where a recording ends"},
        {"--size", NULL, ENF_OPTION_SIZE, o->size, "WxH", NULL, "of the window, pixels (as set; at first 1280x720)"},
        {"--fullscreen", NULL, ENF_OPTION_FLAG, &o->fullscreen, NULL, NULL, "the whole screen"},
        {"--seed", NULL, ENF_OPTION_NUMBER, &seed, "N", NULL, "of the game's dice (1)"},
        {"--river", NULL, ENF_OPTION_TEXT, &o->river, "FILE.csv", NULL, "the guided tour (maps/MAP/river.csv)"},
        {"--config", NULL, ENF_OPTION_TEXT, &o->config, "FILE.json", NULL, "the settings"},
        {"--tell", NULL, ENF_OPTION_FLAG, &o->tell, NULL, NULL, "say on stdout what goes on (for tests)"},
        {"--mute", NULL, ENF_OPTION_FLAG, &o->mute, NULL, NULL, "no sound"},
    };
    const EnfCli cli = {"enfilade", "[options]", about, options, sizeof options / sizeof *options};
    uint32_t count = 0;
    EnfCliResult result = enf_cli_parse(&cli, argc, argv, NULL, 0, &count);
    if (result != ENF_CLI_RUN) {
        return result;
    }
    if (!(seed >= 0.0 && seed <= (double)UINT32_MAX) || seed != floor(seed)) {
        return enf_cli_fail(&cli, "--seed takes a whole number from 0 to 2^32 - 1");
    }
    o->seed = (uint32_t)seed;
    if (!(o->speed > 0.0 && o->speed <= 1000.0)) {
        return enf_cli_fail(&cli, "--speed must be above 0 and at most 1000");
    }
    const char *wrong = nonsense(o);
    return wrong ? enf_cli_fail(&cli, "%s", wrong) : ENF_CLI_RUN;
}
