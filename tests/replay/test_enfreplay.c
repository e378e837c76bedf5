/* enfreplay as it is called: records, verifies, draws, updates; what it says of divergences, damage, foreign recordings and wrong
 * scripts; its exit statuses. */
#include "harness/program.h"
#include "scenes/rooms.h"

#include <enfilade/replay.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EXPECT(arguments, status, ...) ENF_TEST_EXPECT("enfreplay", arguments, status, __VA_ARGS__)

static void write_text(const char *name, const char *text) {
    enf_test_write_file(enf_test_temp_path(name), text, strlen(text));
}

static void write_rooms(const char *name, uint32_t nx) {
    EnfRooms rooms;
    EnfRoomsDef def = enf_rooms_def_default();
    EnfError error = {0};
    def.nx = nx;
    def.nz = 1;
    if (!enf_rooms_create(&rooms, &def, &error) || enf_map_write(rooms.map, enf_test_temp_path(name), &error)) {
        fail_msg("%s", error.message);
    }
    enf_rooms_destroy(&rooms);
}

static int make_folder(void **state) {
    (void)state;
    write_rooms("rooms.enfmap", 3);
    write_rooms("other.enfmap", 2);
    write_text("walk.script", "enfinput 1\n"
                              "30            # stand\n"
                              "\n"
                              "repeat 2\n"
                              "  repeat 2\n"
                              "    40 forward run yaw=45\n"
                              "  end\n"
                              "  20 back=0.5 left pitch=-10 jump\n"
                              "end\n"
                              "1 use button=9\n");
    return 0;
}

/* ---- scripts ---------------------------------------------------------------------------------------------------- */

static void script_becomes_input(void **state) {
    (void)state;
    EXPECT("record --map @/rooms.enfmap -s @/walk.script -o @/walk.enfreplay --title 'A walk' --seed 0x7", 0,
           "231 ticks, 3.9 s");
    EnfReplay replay;
    EnfError error;
    assert_int_equal(enf_replay_read(&replay, enf_test_temp_path("walk.enfreplay"), ENF_REPLAY_WHOLE, NULL, &error), ENF_OK);
    assert_true(replay.ticks == 231 && replay.header.seed == 7);
    assert_string_equal(replay.header.map, "rooms");
    assert_string_equal(replay.header.script, "walk.script");
    EnfReplayCursor cursor = enf_replay_begin(&replay);
    const EnfReplayTick *tick;
    int64_t yaw = 0, pitch = 0;
    while ((tick = enf_replay_next(&cursor)) != NULL) {
        yaw += tick->input.yaw;
        pitch += tick->input.pitch;
        bool running = (tick->tick >= 30 && tick->tick < 110) || (tick->tick >= 130 && tick->tick < 210);
        bool jumping = (tick->tick >= 110 && tick->tick < 130) || (tick->tick >= 210 && tick->tick < 230);
        assert_int_equal(tick->input.forward, running ? 32767 : jumping ? -16384 : 0);
        assert_int_equal(tick->input.right, jumping ? -32767 : 0);
        assert_int_equal(tick->input.buttons, running           ? ENF_BUTTON_RUN
                                              : jumping         ? ENF_BUTTON_JUMP
                                              : tick->tick < 30 ? 0
                                                                : ENF_BUTTON_USE | 512);
    }
    assert_true(yaw == 180 * ENF_INPUT_DEGREE && pitch == -20 * ENF_INPUT_DEGREE);
    enf_replay_free(&replay);
}

static void bad_script_is_refused_by_line(void **state) {
    (void)state;
    static const struct {
        const char *text, *message;
    } bad[] = {{"enfinput 1\n30 forwards\n", "line 2: not understood: forwards"},
               {"enfinput 1\n\n30 forward=2\n", "line 3: not understood: forward"},
               {"enfinput 1\n30 yaw\n", "line 2: not understood: yaw"},
               {"enfinput 1\n30 yaw=x\n", "line 2: not a number: x"},
               {"enfinput 1\nwalk\n", "line 2: a line begins with a number of ticks"},
               {"enfinput 1\n0 run\n", "line 2: a line begins with a number of ticks"},
               {"enfinput 1\nrepeat\n", "line 2: \"repeat\" wants a number"},
               {"enfinput 1\n5\nrepeat 3\n5\n", "line 3: \"repeat\" without \"end\""},
               {"enfinput 1\nend\n", "line 2: \"end\" without \"repeat\""},
               {"enfinput 1\n2000000\n2000000\n", "line 3: the script is longer"},
               {"enfinput 1\nrepeat 3000000\n2\nend\n", "line 4: the script is longer"},
               {"enfinput 1\n5 button=32\n", "line 2: not understood: button"}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        write_text("bad.script", bad[i].text);
        EXPECT("record --map @/rooms.enfmap -s @/bad.script -o @/bad.enfreplay", 1, "bad.script", bad[i].message);
    }
    EXPECT("info @/bad.enfreplay", 1, "cannot open");
}

/* A bot's script is told from a script of inputs by its first line. */
static void bot_plays(void **state) {
    (void)state;
    write_text("bot.script", "enfbot 1\nwait 1\nlook by 90 0\nwalk 1 0 0.5\n");
    EXPECT("record --map @/rooms.enfmap -s @/bot.script -o @/bot.enfreplay", 0, "playing in room_");
    EXPECT("verify @/bot.enfreplay", 0, "ok", "playing in room_");
    write_text("bot.script", "enfbot 1\nwait 1\ndance\n");
    EXPECT("record --map @/rooms.enfmap -s @/bot.script -o @/lost.enfreplay", 1, "bot.script", "line 3 of the bot's script");
    write_text("bot.script", "enfbot 1\nexpect won 1\n");
    EXPECT("record --map @/rooms.enfmap -s @/bot.script -o @/lost.enfreplay", 1, "line 2 of the bot's script");
    EXPECT("record --map @/rooms.enfmap --mash 1 --start gently -o @/lost.enfreplay", 1, "cannot start as \"gently\"");
    EXPECT("info @/lost.enfreplay", 1, "cannot open");
}

/* ---- recordings ------------------------------------------------------------------------------------------------- */

static void mash_is_the_same_each_time(void **state) {
    (void)state;
    EXPECT("record --map @/rooms.enfmap --mash 5 --builder --ticks 1500 -o @/mash.enfreplay", 0, "1500 ticks");
    EXPECT("record --map @/rooms.enfmap --mash 5 --builder --ticks 1500 -o @/again.enfreplay", 0, "1500 ticks");
    EXPECT("record --map @/rooms.enfmap --mash 6 --ticks 100 -o @/six.enfreplay --fields-every 60", 0, "100 ticks");
    size_t size, again;
    char *a = (char *)enf_test_read_file(enf_test_temp_path("mash.enfreplay"), &size);
    char *b = (char *)enf_test_read_file(enf_test_temp_path("again.enfreplay"), &again);
    assert_true(size == again && memcmp(a, b, size) == 0);
    free(a);
    free(b);
    EXPECT("verify @/mash.enfreplay @/six.enfreplay", 0, "mash.enfreplay: ok, 1500 ticks", "2 recordings, 0 of them");
    EXPECT("verify --dbv maximal @/mash.enfreplay", 0, "ok");
    EXPECT("verify --quiet --dbv reach @/mash.enfreplay", 0, "");
    EXPECT("info @/six.enfreplay", 0, "at each 60th tick", "mash 6", "rooms (");
    EXPECT("info --json @/mash.enfreplay", 0, "\"ticks\": 1500", "\"complete\": true");
}

static void pictures_change_nothing(void **state) {
    (void)state;
    EXPECT("record --map @/rooms.enfmap -s @/walk.script -o @/walk.enfreplay", 0, "231 ticks");
    EXPECT("run @/walk.enfreplay --frames @/frames --every 100 --size 64x48 --video @/walk.y4m --dbv adaptive --stats @/s.json",
           0, "231 ticks (");
    EXPECT("run @/walk.enfreplay --cull none --video - --size 32x16 --every 231", 0, "YUV4MPEG2 W32 H16 F60:231",
           "231 ticks (");
    size_t size;
    free(enf_test_read_file(enf_test_temp_path("frames/000200.png"), &size));
    char *video = (char *)enf_test_read_file(enf_test_temp_path("walk.y4m"), &size);
    const char *header = "YUV4MPEG2 W64 H48 F60:100 Ip A1:1 C444\n";
    assert_memory_equal(video, header, strlen(header));
    assert_int_equal(size, strlen(header) + 3 * (6 + 3 * 64 * 48));
    free(video);
    char *stats = (char *)enf_test_read_file(enf_test_temp_path("s.json"), &size);
    assert_true(strstr(stats, "\"views\": 231,") && strstr(stats, "\"pictures\": 3,") && strstr(stats, "\"late\": 0,"));
    free(stats);
    EXPECT("run @/walk.enfreplay --speed 100 --ticks 60", 0, "60 ticks (1.0 s)");
    EXPECT("run @/walk.enfreplay --frames @/walk.y4m", 1, "is no folder");
}

/* Copies a recording with the hash of one tick, and of one field of it, changed. */
static void tamper(const char *from, const char *to, uint64_t at, uint32_t field) {
    EnfReplay replay;
    EnfRecorder *recorder;
    EnfError error;
    assert_int_equal(enf_replay_read(&replay, enf_test_temp_path(from), ENF_REPLAY_WHOLE, NULL, &error), ENF_OK);
    assert_int_equal(enf_recorder_create(&recorder, &replay.header, enf_test_temp_path(to), NULL, &error), ENF_OK);
    EnfReplayCursor cursor = enf_replay_begin(&replay);
    const EnfReplayTick *tick;
    while ((tick = enf_replay_next(&cursor)) != NULL) {
        uint64_t fields[ENF_REPLAY_FIELDS_MAX]; /* 16 bits fold to themselves */
        for (uint32_t i = 0; i < ENF_REPLAY_FIELDS_MAX; i++) {
            fields[i] = tick->fields[i] ^ (uint64_t)(tick->tick == at && i == field);
        }
        uint64_t hash = tick->hash ^ (uint64_t)(tick->tick == at);
        assert_int_equal(enf_recorder_tick(recorder, &tick->input, hash, fields, &error), ENF_OK);
    }
    assert_int_equal(enf_recorder_finish(recorder, &error), ENF_OK);
    enf_recorder_destroy(recorder);
    enf_replay_free(&replay);
}

static void divergence_is_named(void **state) {
    (void)state;
    EXPECT("record --map @/rooms.enfmap -s @/walk.script -o @/walk.enfreplay", 0, "231 ticks");
    tamper("walk.enfreplay", "tampered.enfreplay", 100, 0);
    EnfReplay replay;
    assert_int_equal(enf_replay_read(&replay, enf_test_temp_path("walk.enfreplay"), ENF_REPLAY_WHOLE, NULL, NULL), ENF_OK);
    char fields[64];
    snprintf(fields, sizeof fields, "fields that differ: %s\n", replay.header.fields[0]);
    enf_replay_free(&replay);
    EXPECT("verify @/walk.enfreplay @/tampered.enfreplay", 1, "walk.enfreplay: ok",
           "tampered.enfreplay: DIVERGED at tick 100 (1.67 s)", fields, "2 recordings, 1 of them");
    EXPECT("run @/tampered.enfreplay", 1, "DIVERGED at tick 100", "100 ticks");
    EXPECT("run --force @/tampered.enfreplay", 1, "DIVERGED at tick 100", "231 ticks");
    EXPECT("update @/tampered.enfreplay", 0, "231 ticks");
    EXPECT("verify @/tampered.enfreplay", 0, "ok");
    size_t size, again;
    char *a = (char *)enf_test_read_file(enf_test_temp_path("walk.enfreplay"), &size);
    char *b = (char *)enf_test_read_file(enf_test_temp_path("tampered.enfreplay"), &again);
    assert_true(size == again && memcmp(a, b, size) == 0); /* byte for byte what it was before */
    free(a);
    free(b);
}

static void foreign_recording_is_refused(void **state) {
    (void)state;
    EXPECT("record --map @/rooms.enfmap -s @/walk.script -o @/walk.enfreplay", 0, "231 ticks");
    EXPECT("verify --map @/other.enfmap @/walk.enfreplay", 1, "recorded with the map rooms (", "this is the map ",
           "other.enfmap");
    EXPECT("verify --maps @/nowhere @/walk.enfreplay", 1, "recorded on the map \"rooms\"", "--map FILE");
    EXPECT("update --map @/other.enfmap @/walk.enfreplay", 1, "recorded on the map rooms, not on other", "--force");
    EXPECT("verify @/walk.enfreplay", 0, "ok"); /* and is what it was */
    EXPECT("update --map @/other.enfmap --force @/walk.enfreplay", 0, "231 ticks");
    EXPECT("verify @/walk.enfreplay", 0, "ok");
    EXPECT("info @/walk.enfreplay", 0, "map          other (");
}

static void damaged_recording_is_refused_or_salvaged(void **state) {
    (void)state;
    EXPECT("record --map @/rooms.enfmap --mash 5 --ticks 700 -o @/mash.enfreplay", 0, "700 ticks");
    size_t size;
    uint8_t *bytes = enf_test_read_file(enf_test_temp_path("mash.enfreplay"), &size);
    enf_test_write_file(enf_test_temp_path("cut.enfreplay"), bytes, size - 30);
    free(bytes);
    EXPECT("verify @/cut.enfreplay", 1, "cut.enfreplay: the recording ends in the chunk that begins at tick 512 (byte ");
    EXPECT("verify --salvage @/cut.enfreplay", 0, "the 512 ticks before are taken", "ok, 512 ticks");
    EXPECT("info --salvage @/cut.enfreplay", 0, "incomplete");
    EXPECT("verify @/rooms.enfmap", 1, "not a recording");
    EXPECT("verify @/absent.enfreplay @/mash.enfreplay", 1, "cannot open", "mash.enfreplay: ok");
}

/* ---- command line ----------------------------------------------------------------------------------------------- */

static void command_line_is_checked(void **state) {
    (void)state;
    EXPECT("--help", 0, "usage: enfreplay COMMAND", "verify", "example:");
    EXPECT("--version", 0, "enfreplay ");
    EXPECT("verify --help", 0, "usage: enfreplay verify", "--maps FOLDER");
    EXPECT("", 2, "which command?");
    EXPECT("play", 2, "no command is named play");
    EXPECT("verify", 2, "which recording?");
    EXPECT("run a b", 2, "one recording");
    EXPECT("run a --every 0", 2, "--every");
    EXPECT("verify a --map b --maps c", 2, "exclude each other");
    EXPECT("record --map a -o b", 2, "one of --script, --path and --mash");
    EXPECT("record --map a -o b --mash 1 --script c", 2, "one of --script, --path and --mash");
    EXPECT("record --mash 1", 2, "are needed");
    EXPECT("record --map a -o b --mash 1 c", 2, "unexpected argument");
    EXPECT("record --map @/rooms.enfmap -o @/b --mash x", 2, "--mash wants a number");
    EXPECT("record --map @/rooms.enfmap -o @/b --mash 1 --seed -1", 2, "--seed wants a number");
    EXPECT("record --map @/rooms.enfmap -o @/nowhere/b --mash 1", 1, "cannot open for writing");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup(script_becomes_input, make_folder),
    cmocka_unit_test_setup(bad_script_is_refused_by_line, make_folder),
    cmocka_unit_test_setup(bot_plays, make_folder),
    cmocka_unit_test_setup(mash_is_the_same_each_time, make_folder),
    cmocka_unit_test_setup(pictures_change_nothing, make_folder),
    cmocka_unit_test_setup(divergence_is_named, make_folder),
    cmocka_unit_test_setup(foreign_recording_is_refused, make_folder),
    cmocka_unit_test_setup(damaged_recording_is_refused_or_salvaged, make_folder),
    cmocka_unit_test_setup(command_line_is_checked, make_folder),
};

ENF_TEST_MAIN(tests)
