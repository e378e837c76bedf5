/* What a person sets, in the menu and in a JSON file of the user's configuration folder. */
#ifndef GAME_FRONT_SETTINGS_H
#define GAME_FRONT_SETTINGS_H

#include <enfilade/base.h>

/** What keys can do: X(NAME, "key in the file", "label", default scancode of SDL 2). */
#define SETTINGS_ACTIONS(X)                                                                                                    \
    X(FORWARD, "forward", "Forward", SDL_SCANCODE_W)                                                                           \
    X(BACK, "back", "Back", SDL_SCANCODE_S)                                                                                    \
    X(LEFT, "left", "Left", SDL_SCANCODE_A)                                                                                    \
    X(RIGHT, "right", "Right", SDL_SCANCODE_D)                                                                                 \
    X(JUMP, "jump", "Jump", SDL_SCANCODE_SPACE)                                                                                \
    X(CROUCH, "crouch", "Crouch", SDL_SCANCODE_LCTRL)                                                                          \
    X(RUN, "run", "Run", SDL_SCANCODE_LSHIFT)                                                                                  \
    X(USE, "use", "Use, take", SDL_SCANCODE_E)                                                                                 \
    X(DROP, "drop", "Put down", SDL_SCANCODE_Q)                                                                                \
    X(MAP, "map", "Map of the building", SDL_SCANCODE_TAB)

typedef enum Action {
#define SETTINGS_ACTION_ENUM(name, key, label, code) ACTION_##name,
    SETTINGS_ACTIONS(SETTINGS_ACTION_ENUM)
#undef SETTINGS_ACTION_ENUM
        ACTION_COUNT
} Action;

/** Numbers: X(field, least, most, default). */
#define SETTINGS_NUMBERS(X)                                                                                                    \
    X(sensitivity, 0.1, 5.0, 1.0)                                                                                              \
    X(fov, 45.0, 100.0, 62.0)                                                                                                  \
    X(volume, 0.0, 1.0, 0.8)                                                                                                   \
    X(music, 0.0, 1.0, 0.6)                                                                                                    \
    X(width, 320.0, 7680.0, 1280.0)                                                                                            \
    X(height, 240.0, 4320.0, 720.0)                                                                                            \
    X(render_scale, 0.25, 1.0, 1.0)
/** Flags: X(field, default). */
#define SETTINGS_FLAGS(X)                                                                                                      \
    X(invert, false)                                                                                                           \
    X(fullscreen, false)                                                                                                       \
    X(vsync, true)

typedef struct Settings {
#define SETTINGS_NUMBER_FIELD(name, least, most, usual) double name;
    SETTINGS_NUMBERS(SETTINGS_NUMBER_FIELD)
#undef SETTINGS_NUMBER_FIELD
#define SETTINGS_FLAG_FIELD(name, usual) bool name;
    SETTINGS_FLAGS(SETTINGS_FLAG_FIELD)
#undef SETTINGS_FLAG_FIELD
    int keys[ACTION_COUNT]; /**< scancodes; 0: none */
} Settings;

Settings settings_default(void);
bool settings_equal(const Settings *a, const Settings *b);
const char *settings_action_label(Action action);

#define SETTINGS_PATH_SIZE 1024
/** XDG_CONFIG_HOME/enfilade/settings.json, else HOME/.config/...; false without either. */
bool settings_find_path(char path[SETTINGS_PATH_SIZE]);
/** Reads a file over the defaults: what it lacks, or has of another kind, stays; numbers are held in their ranges. A file that is
 *  absent is no error; one that is no JSON object is, and the defaults stay. */
EnfResult settings_read(Settings *settings, const char *path, EnfError *error);
/** Atomically; makes the folder. */
EnfResult settings_write(const Settings *settings, const char *path, EnfError *error);

#endif
