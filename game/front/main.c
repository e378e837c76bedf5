/* enfilade: Night at the palace, and a walk through any compiled level. */
#include "front/app.h"

int main(int argc, char **argv) {
    static App app; /* some hundred KB: too much for a stack */
    EnfCliResult parsed = options_parse(&app.options, argc, argv);
    if (parsed != ENF_CLI_RUN) {
        return parsed == ENF_CLI_DONE ? ENF_EXIT_OK : ENF_EXIT_USAGE;
    }
    return app_run(&app);
}
