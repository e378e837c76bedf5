/* What the files of enfinfo share. */
#ifndef ENFINFO_INFO_H
#define ENFINFO_INFO_H

#include "common/cli.h"
#include <enfilade/vis.h>

typedef struct Options {
    const char *map_path;
    bool check, cells, portals, materials, lights, entities, movers, meshes, json, why;
    /* why */
    double eye[3];
    double yaw_deg, pitch_deg, fov_y_deg;
    uint32_t size[2];
    const char *cell, *from;
    int window;
} Options;

/** A number of bytes for people: "4.1 MiB". Returns `out`. */
const char *info_bytes(uint64_t bytes, char out[32]);
/** Triangles of a cell's own clusters. */
uint32_t info_triangles(const EnfMap *map, uint32_t cell);
/** The words for flags, in `out`: "open outside", or "". */
const char *info_cell_flags(const EnfMap *map, uint32_t cell, char out[64]);
const char *info_portal_flags(const EnfMap *map, uint32_t portal, char out[96]);
const char *info_material_flags(const EnfMap *map, uint32_t material, char out[96]);
const char *info_mover_flags(const EnfMap *map, uint32_t mover, char out[96]);
/** "still", "path", "hinge", "slide" or "free"; what a path does at its ends, "" for others. */
const char *info_mover_kind(const EnfMap *map, uint32_t mover);
const char *info_mover_wrap(const EnfMap *map, uint32_t mover);
uint32_t info_movers_of_kind(const EnfMap *map, EnfMoverKind kind);
/** Of a mesh: triangles, vertices, and the movers that share it. */
uint32_t info_mesh_triangles(const EnfMap *map, uint32_t mesh);
uint32_t info_mesh_vertices(const EnfMap *map, uint32_t mesh);
uint32_t info_mesh_users(const EnfMap *map, uint32_t mesh);
/** A cell's name; "none" for ENF_NONE. */
const char *info_cell_name(const EnfMap *map, uint32_t cell);
/** Square metres of a half-portal's polygon. */
double info_portal_area(const EnfMap *map, uint32_t portal);

/** The chunks of a map: name, records, bytes. Calls `each` in the file's order. */
typedef void InfoChunkFn(void *user, const char *fourcc, const char *name, uint32_t records, uint64_t bytes);
void info_chunks(const EnfMap *map, InfoChunkFn *each, void *user);

/* What is printed; overview.c, tables.c, movers.c, as_json.c. */
void info_print_overview(const EnfMap *map, const Options *options);
void info_print_cells(const EnfMap *map, uint32_t rows);
void info_print_portals(const EnfMap *map);
void info_print_materials(const EnfMap *map);
void info_print_lights(const EnfMap *map);
void info_print_entities(const EnfMap *map);
void info_print_movers(const EnfMap *map);
void info_print_meshes(const EnfMap *map);
/** Everything as JSON on stdout; false, with a message, when it cannot be written. */
bool info_print_json(const EnfMap *map, const Options *options);

/** why.c: why a cell is seen from an eye, or is not. The exit status: 0 seen, 1 hidden or failed. */
int info_why(const EnfMap *map, const Options *options);

#endif
