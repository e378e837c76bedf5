/* enfinfo: what is in a map, whether it is sound, and why a cell is seen. */
#include "enfinfo/info.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char about[] =
    "Prints what is in a compiled level: counts, sizes, cells; with options, lists of the rest.\n"
    "'why' tells how the eye sees a cell: the chain of portals and windows that admits it, or the portals where every\n"
    "way to it was cut.\n"
    "Exit status: 0; 1 if the map is not sound, or 'why' finds the cell hidden; 2 for a wrong command line.";

static EnfCliResult check_arguments(const EnfCli *cli, Options *o, const char **words, uint32_t count) {
    if (count == 2 && strcmp(words[0], "why") == 0) {
        o->why = true;
        o->map_path = words[1];
    } else if (count == 2 && strcmp(words[1], "why") == 0) {
        o->why = true;
        o->map_path = words[0];
    } else if (count == 2) {
        return enf_cli_fail(cli, "one map at a time, not '%s' and '%s'", words[0], words[1]);
    } else {
        o->map_path = count ? words[0] : NULL;
    }
    if (!o->map_path || strcmp(o->map_path, "why") == 0) {
        return enf_cli_fail(cli, "which map? Compile one with enfc");
    }
    if (o->why && (isnan(o->eye[0]) || !o->cell)) {
        return enf_cli_fail(cli, "why needs --eye X,Y,Z and --cell NAME");
    }
    if (!o->why && (!isnan(o->eye[0]) || o->cell || o->from)) {
        return enf_cli_fail(cli, "--eye, --cell and --from belong to 'why'");
    }
    if (!(o->fov_y_deg > 0.0 && o->fov_y_deg <= 170.0)) {
        return enf_cli_fail(cli, "--fov-y must be above 0 and at most 170 degrees");
    }
    return ENF_CLI_RUN;
}

static EnfCliResult parse(Options *o, int argc, char **argv) {
    const EnfOption table[] = {
        {"--check", NULL, ENF_OPTION_FLAG, &o->check, NULL, NULL, "only say whether the map is sound"},
        {"--cells", NULL, ENF_OPTION_FLAG, &o->cells, NULL, NULL, "list all cells"},
        {"--portals", NULL, ENF_OPTION_FLAG, &o->portals, NULL, NULL, "list the half-portals"},
        {"--materials", NULL, ENF_OPTION_FLAG, &o->materials, NULL, NULL, "list the materials"},
        {"--lights", NULL, ENF_OPTION_FLAG, &o->lights, NULL, NULL, "list the lights"},
        {"--entities", NULL, ENF_OPTION_FLAG, &o->entities, NULL, NULL, "list spawn points, cameras, markers"},
        {"--movers", NULL, ENF_OPTION_FLAG, &o->movers, NULL, NULL, "list what moves: how, where, what it closes"},
        {"--meshes", NULL, ENF_OPTION_FLAG, &o->meshes, NULL, NULL, "list the meshes of what moves"},
        {"--json", NULL, ENF_OPTION_FLAG, &o->json, NULL, NULL, "the lists asked for (or all) as JSON"},
        {"--eye", NULL, ENF_OPTION_VECTOR, o->eye, "X,Y,Z", NULL, "why: where the eye is, metres"},
        {"--yaw", NULL, ENF_OPTION_NUMBER, &o->yaw_deg, "DEG", NULL, "why: counter-clockwise about +Y, 0 looks down -Z"},
        {"--pitch", NULL, ENF_OPTION_NUMBER, &o->pitch_deg, "DEG", NULL, "why: up is positive"},
        {"--fov-y", NULL, ENF_OPTION_NUMBER, &o->fov_y_deg, "DEG", NULL, "why: vertical field of view (60)"},
        {"--size", NULL, ENF_OPTION_SIZE, o->size, "WxH", NULL, "why: picture in pixels (640x480)"},
        {"--window", NULL, ENF_OPTION_CHOICE, &o->window, NULL, "box|polygon", "why: shape of windows (box)"},
        {"--cell", NULL, ENF_OPTION_TEXT, &o->cell, "NAME", NULL, "why: the cell to explain"},
        {"--from", NULL, ENF_OPTION_TEXT, &o->from, "NAME", NULL, "why: the eye's cell, if not by location"},
    };
    const EnfCli cli = {"enfinfo", "MAP.enfmap [options] | why MAP.enfmap --eye X,Y,Z --cell NAME [options]", about, table,
                        sizeof table / sizeof *table};
    const char *words[2];
    uint32_t count;
    EnfCliResult result = enf_cli_parse(&cli, argc, argv, words, 2, &count);
    return result == ENF_CLI_RUN ? check_arguments(&cli, o, words, count) : result;
}

static void print_error(const EnfError *error) {
    fprintf(stderr, "enfinfo: %s: ", error->file);
    if (error->offset != UINT64_MAX) {
        fprintf(stderr, "at byte %llu: ", (unsigned long long)error->offset);
    }
    fprintf(stderr, "%s (%s)\n", error->message, enf_result_text(error->code));
}

static void print_lists(const EnfMap *map, const Options *o) {
    const struct {
        void (*print)(const EnfMap *);
        bool wanted;
    } lists[] = {{info_print_portals, o->portals},   {info_print_materials, o->materials}, {info_print_lights, o->lights},
                 {info_print_entities, o->entities}, {info_print_movers, o->movers},       {info_print_meshes, o->meshes}};
    bool any = o->cells;
    if (o->cells) {
        info_print_cells(map, UINT32_MAX);
    }
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        if (lists[i].wanted) {
            fputs(any ? "\n" : "", stdout);
            lists[i].print(map);
            any = true;
        }
    }
    if (!any) {
        info_print_overview(map, o);
    }
}

static int run(const EnfMap *map, const Options *o) {
    if (o->why) {
        return info_why(map, o);
    }
    if (o->check) {
        printf("%s: OK: %u cells, %u portals, %u triangles, content %016llx\n", o->map_path, map->cells_count,
               map->portals_count, map->indices_count / 3, (unsigned long long)map->hash);
        return ENF_EXIT_OK;
    }
    if (o->json) {
        return info_print_json(map, o) ? ENF_EXIT_OK : ENF_EXIT_FAILURE;
    }
    print_lists(map, o);
    return ENF_EXIT_OK;
}

int main(int argc, char **argv) {
    Options options = {.eye = {(double)NAN, 0, 0}, .fov_y_deg = 60.0, .size = {640, 480}};
    EnfCliResult parsed = parse(&options, argc, argv);
    if (parsed != ENF_CLI_RUN) {
        return parsed == ENF_CLI_DONE ? ENF_EXIT_OK : ENF_EXIT_USAGE;
    }
    EnfMap map;
    EnfError error = {.offset = UINT64_MAX};
    if (enf_map_read(&map, options.map_path, NULL, &error) != ENF_OK) { /* reading checks */
        print_error(&error);
        return ENF_EXIT_FAILURE;
    }
    int status = run(&map, &options);
    enf_map_free(&map);
    return status;
}
