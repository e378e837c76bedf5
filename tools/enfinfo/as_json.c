/* What the tables show, for programs: one JSON object on stdout. */
#include "common/report.h"
#include "enfinfo/info.h"

#include <stdio.h>

static void put_vec3(EnfReport *r, const char *key, EnfVec3 v) {
    enf_report_array(r, key);
    enf_report_number(r, NULL, v.x);
    enf_report_number(r, NULL, v.y);
    enf_report_number(r, NULL, v.z);
    enf_report_end_array(r);
}

static void put_chunk(void *user, const char *fourcc, const char *name, uint32_t records, uint64_t bytes) {
    EnfReport *r = user;
    enf_report_object(r, NULL);
    enf_report_text(r, "chunk", fourcc);
    enf_report_text(r, "name", name);
    enf_report_count(r, "records", records);
    enf_report_count(r, "bytes", bytes);
    enf_report_end_object(r);
}

static void put_counts(EnfReport *r, const EnfMap *map) {
    char hash[17];
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)map->hash);
    enf_report_text(r, "hash", hash);
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)map->source_hash);
    enf_report_text(r, "source_hash", hash);
    enf_report_count(r, "bytes", map->file.size);
    enf_report_count(r, "cell_count", map->cells_count);
    enf_report_count(r, "portal_count", map->portals_count);
    enf_report_count(r, "triangle_count", map->indices_count / 3);
    enf_report_count(r, "vertex_count", map->vertices_count);
    enf_report_count(r, "cluster_count", map->clusters_count);
    enf_report_count(r, "kd_node_count", map->kd_nodes_count);
    enf_report_count(r, "material_count", map->materials_count);
    enf_report_count(r, "image_count", map->images_count);
    enf_report_count(r, "light_count", map->lights_count);
    enf_report_count(r, "entity_count", map->entities_count);
    enf_report_count(r, "path_count", map->paths_count);
    enf_report_count(r, "mover_count", map->movers_count);
    enf_report_count(r, "mesh_count", map->meshes_count);
    enf_report_array(r, "chunks");
    info_chunks(map, put_chunk, r);
    enf_report_end_array(r);
}

static void put_cells(EnfReport *r, const EnfMap *map) {
    enf_report_array(r, "cells");
    for (uint32_t i = 0; i < map->cells_count; i++) {
        const EnfCell *c = &map->cells[i];
        EnfVec3 origin = enf_v3(c->origin[0], c->origin[1], c->origin[2]);
        char flags[64];
        enf_report_object(r, NULL);
        enf_report_text(r, "name", info_cell_name(map, i));
        put_vec3(r, "min", enf_add(origin, enf_v3((double)c->min[0], (double)c->min[1], (double)c->min[2])));
        put_vec3(r, "max", enf_add(origin, enf_v3((double)c->max[0], (double)c->max[1], (double)c->max[2])));
        enf_report_number(r, "priority", c->priority);
        enf_report_count(r, "portals", c->portal_count);
        enf_report_count(r, "clusters", c->cluster_count);
        enf_report_count(r, "triangles", info_triangles(map, i));
        enf_report_count(r, "kd_nodes", c->node_count);
        enf_report_count(r, "lights", c->light_count);
        enf_report_text(r, "flags", info_cell_flags(map, i, flags));
        enf_report_end_object(r);
    }
    enf_report_end_array(r);
}

static void put_portals(EnfReport *r, const EnfMap *map) {
    enf_report_array(r, "portals");
    for (uint32_t i = 0; i < map->portals_count; i++) {
        const EnfPortal *p = &map->portals[i];
        const EnfCell *c = &map->cells[p->source];
        char flags[96];
        enf_report_object(r, NULL);
        enf_report_text(r, "name", enf_map_string(map, p->name));
        enf_report_text(r, "from", info_cell_name(map, p->source));
        enf_report_text(r, "to", info_cell_name(map, p->target));
        if (p->twin == ENF_NONE) {
            enf_report_null(r, "twin");
        } else {
            enf_report_count(r, "twin", p->twin);
        }
        enf_report_number(r, "area", info_portal_area(map, i));
        enf_report_text(r, "flags", info_portal_flags(map, i, flags));
        enf_report_array(r, "points");
        for (uint32_t k = 0; k < p->vertex_count; k++) {
            EnfVec3 local = enf_v3_from_f(map->portal_vertices[p->vertex_first + k]);
            put_vec3(r, NULL, enf_add(enf_v3(c->origin[0], c->origin[1], c->origin[2]), local));
        }
        enf_report_end_array(r);
        enf_report_end_object(r);
    }
    enf_report_end_array(r);
}

static void put_materials(EnfReport *r, const EnfMap *map) {
    enf_report_array(r, "materials");
    for (uint32_t i = 0; i < map->materials_count; i++) {
        const EnfMaterial *m = &map->materials[i];
        char flags[96];
        enf_report_object(r, NULL);
        enf_report_text(r, "name", enf_map_string(map, m->name));
        enf_report_text(r, "flags", info_material_flags(map, i, flags));
        enf_report_array(r, "base_color");
        for (int k = 0; k < 4; k++) {
            enf_report_number(r, NULL, (double)m->base_color[k]);
        }
        enf_report_end_array(r);
        if (m->texture == ENF_NONE) {
            enf_report_null(r, "image");
        } else {
            enf_report_text(r, "image", enf_map_string(map, map->images[map->textures[m->texture].image].name));
        }
        enf_report_end_object(r);
    }
    enf_report_end_array(r);
}

static void put_lights(EnfReport *r, const EnfMap *map) {
    static const char *const kinds[] = {"point", "spot", "directional"};
    enf_report_array(r, "lights");
    for (uint32_t i = 0; i < map->lights_count; i++) {
        const EnfLight *l = &map->lights[i];
        enf_report_object(r, NULL);
        enf_report_text(r, "name", enf_map_string(map, l->name));
        enf_report_text(r, "kind", kinds[l->kind]);
        enf_report_text(r, "cell", info_cell_name(map, l->cell));
        put_vec3(r, "position", enf_v3(l->position[0], l->position[1], l->position[2]));
        put_vec3(r, "color", enf_v3((double)l->color[0], (double)l->color[1], (double)l->color[2]));
        enf_report_number(r, "range", (double)l->range);
        enf_report_end_object(r);
    }
    enf_report_end_array(r);
}

static void put_entities(EnfReport *r, const EnfMap *map) {
    enf_report_array(r, "entities");
    for (uint32_t i = 0; i < map->entities_count; i++) {
        const EnfEntity *e = &map->entities[i];
        enf_report_object(r, NULL);
        enf_report_text(r, "name", enf_map_string(map, e->name));
        enf_report_text(r, "class", enf_map_string(map, e->classname));
        enf_report_text(r, "cell", info_cell_name(map, e->cell));
        put_vec3(r, "position", enf_v3(e->translation[0], e->translation[1], e->translation[2]));
        enf_report_text(r, "extras", enf_map_string(map, e->extras));
        enf_report_end_object(r);
    }
    enf_report_end_array(r);
}

static void put_index(EnfReport *r, const char *key, uint32_t index) {
    if (index == ENF_NONE) {
        enf_report_null(r, key);
    } else {
        enf_report_count(r, key, index);
    }
}

/* What there is to say depends on the kind. */
static void put_motion(EnfReport *r, const EnfMap *map, uint32_t mover) {
    const EnfMover *m = &map->movers[mover];
    if (m->kind == ENF_MOVER_PATH) {
        enf_report_text(r, "wrap", info_mover_wrap(map, mover));
        enf_report_number(r, "seconds", (double)m->seconds);
        enf_report_number(r, "phase", (double)m->phase);
        put_index(r, "translation", m->translation);
        put_index(r, "rotation", m->rotation);
        put_index(r, "scale", m->scale);
    } else if (m->kind == ENF_MOVER_HINGE || m->kind == ENF_MOVER_SLIDE) {
        put_vec3(r, "axis", enf_v3((double)m->axis[0], (double)m->axis[1], (double)m->axis[2]));
        put_vec3(r, "pivot", enf_v3(m->pivot[0], m->pivot[1], m->pivot[2]));
        enf_report_number(r, "low", (double)m->low);
        enf_report_number(r, "high", (double)m->high);
        enf_report_number(r, "rate", (double)m->rate);
    }
}

static void put_movers(EnfReport *r, const EnfMap *map) {
    enf_report_array(r, "movers");
    for (uint32_t i = 0; i < map->movers_count; i++) {
        const EnfMover *m = &map->movers[i];
        const EnfEntity *e = &map->entities[m->entity];
        char flags[96];
        enf_report_object(r, NULL);
        enf_report_text(r, "name", enf_map_string(map, e->name));
        enf_report_text(r, "class", enf_map_string(map, e->classname));
        enf_report_text(r, "kind", info_mover_kind(map, i));
        enf_report_count(r, "entity", m->entity);
        put_index(r, "mesh", m->mesh);
        enf_report_text(r, "cell", info_cell_name(map, e->cell));
        put_index(r, "portal", m->portal);
        put_motion(r, map, i);
        enf_report_number(r, "max_speed", (double)m->max_speed);
        enf_report_count(r, "validity_ticks", m->validity_ticks);
        enf_report_text(r, "flags", info_mover_flags(map, i, flags));
        enf_report_end_object(r);
    }
    enf_report_end_array(r);
}

static void put_meshes(EnfReport *r, const EnfMap *map) {
    enf_report_array(r, "meshes");
    for (uint32_t i = 0; i < map->meshes_count; i++) {
        const EnfMesh *m = &map->meshes[i];
        enf_report_object(r, NULL);
        enf_report_text(r, "name", enf_map_string(map, m->name));
        put_vec3(r, "min", enf_v3((double)m->min[0], (double)m->min[1], (double)m->min[2]));
        put_vec3(r, "max", enf_v3((double)m->max[0], (double)m->max[1], (double)m->max[2]));
        enf_report_count(r, "parts", m->part_count);
        enf_report_count(r, "triangles", info_mesh_triangles(map, i));
        enf_report_count(r, "vertices", info_mesh_vertices(map, i));
        enf_report_count(r, "movers", info_mesh_users(map, i));
        enf_report_end_object(r);
    }
    enf_report_end_array(r);
}

/* The lists that were asked for; all of them if none was. */
bool info_print_json(const EnfMap *map, const Options *options) {
    const struct {
        void (*put)(EnfReport *, const EnfMap *);
        bool wanted;
    } lists[] = {{put_cells, options->cells},   {put_portals, options->portals},   {put_materials, options->materials},
                 {put_lights, options->lights}, {put_entities, options->entities}, {put_movers, options->movers},
                 {put_meshes, options->meshes}};
    bool all = true;
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        all = all && !lists[i].wanted;
    }
    EnfReport report = {.pretty = true};
    enf_report_object(&report, NULL);
    enf_report_text(&report, "map", options->map_path);
    put_counts(&report, map);
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        if (all || lists[i].wanted) {
            lists[i].put(&report, map);
        }
    }
    enf_report_end_object(&report);
    EnfError error;
    bool written = enf_report_save(&report, "-", &error) == ENF_OK;
    if (!written) {
        fprintf(stderr, "enfinfo: %s\n", error.message);
    }
    enf_report_free(&report);
    return written;
}
