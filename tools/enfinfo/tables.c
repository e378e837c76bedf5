/* Cells, portals, materials, lights and entities, a row each. */
#include "enfinfo/info.h"
#include "enfinfo/table.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- words ------------------------------------------------------------------------------------------------------ */

static void add_word(char *out, size_t size, bool present, const char *word) {
    size_t length = strlen(out);
    if (present) {
        snprintf(out + length, size - length, "%s%s", length ? " " : "", word);
    }
}

const char *info_cell_flags(const EnfMap *map, uint32_t cell, char out[64]) {
    uint32_t flags = map->cells[cell].flags;
    out[0] = '\0';
    add_word(out, 64, (flags & ENF_CELL_OUTSIDE) != 0, "outside");
    add_word(out, 64, (flags & ENF_CELL_OPEN) != 0, "leaks");
    add_word(out, 64, map->cells[cell].bound_count != 0, "bound");
    return out;
}

const char *info_portal_flags(const EnfMap *map, uint32_t portal, char out[96]) {
    const EnfPortal *p = &map->portals[portal];
    out[0] = '\0';
    add_word(out, 96, (p->flags & ENF_PORTAL_CLOSED) != 0, "closed");
    add_word(out, 96, (p->flags & ENF_PORTAL_OVERLAP) != 0, "overlap");
    add_word(out, 96, (p->flags & ENF_PORTAL_NONPLANAR) != 0, "bent");
    add_word(out, 96, (p->flags & ENF_PORTAL_MIRROR) != 0, "mirror");
    add_word(out, 96, p->transform != ENF_NONE && !(p->flags & ENF_PORTAL_MIRROR), "teleport");
    add_word(out, 96, p->twin == ENF_NONE, "one-way");
    return out;
}

const char *info_material_flags(const EnfMap *map, uint32_t material, char out[96]) {
    const EnfMaterial *m = &map->materials[material];
    out[0] = '\0';
    add_word(out, 96, m->alpha_mode == ENF_ALPHA_MASK, "mask");
    add_word(out, 96, m->alpha_mode == ENF_ALPHA_BLEND, "blend");
    add_word(out, 96, (m->flags & ENF_MATERIAL_DOUBLE_SIDED) != 0, "double-sided");
    add_word(out, 96, (m->flags & ENF_MATERIAL_CLIP) != 0, "clip");
    add_word(out, 96, (m->flags & ENF_MATERIAL_NOCOLLIDE) != 0, "no-collide");
    add_word(out, 96, (m->flags & ENF_MATERIAL_UNLIT) != 0, "unlit");
    add_word(out, 96, (m->flags & ENF_MATERIAL_MIRROR) != 0, "mirror");
    add_word(out, 96, (m->flags & ENF_MATERIAL_NODRAW) != 0, "nodraw");
    add_word(out, 96, m->emissive_texture != ENF_NONE || m->emissive[0] + m->emissive[1] + m->emissive[2] > 0.0f, "glows");
    return out;
}

const char *info_cell_name(const EnfMap *map, uint32_t cell) {
    return cell == ENF_NONE ? "none" : enf_map_string(map, map->cells[cell].name);
}

double info_portal_area(const EnfMap *map, uint32_t portal) {
    const EnfPortal *p = &map->portals[portal];
    const EnfVec3f *points = map->portal_vertices + p->vertex_first;
    EnfVec3 sum = {0, 0, 0};
    for (uint32_t i = 2; i < p->vertex_count; i++) {
        EnfVec3 origin = enf_v3_from_f(points[0]);
        sum = enf_add(sum, enf_cross(enf_sub(enf_v3_from_f(points[i - 1]), origin), enf_sub(enf_v3_from_f(points[i]), origin)));
    }
    return 0.5 * enf_length(sum);
}

/* ---- tables ----------------------------------------------------------------------------------------------------- */

static void finish(Table *table, uint32_t rows, const char *more) {
    table_print(table, rows, more);
    table_free(table);
}

void info_print_cells(const EnfMap *map, uint32_t rows) {
    Table table = {{0}, {0}, 0, NULL, 0, 0, false};
    table_titles(&table, "#cell|name|#size, m|#priority|#portals|#clusters|#triangles|#kd nodes|#lights|flags");
    for (uint32_t i = 0; i < map->cells_count; i++) {
        const EnfCell *c = &map->cells[i];
        char flags[64];
        table_cell(&table, "%u", i);
        table_cell(&table, "%s", info_cell_name(map, i));
        table_cell(&table, "%.1f × %.1f × %.1f", (double)(c->max[0] - c->min[0]), (double)(c->max[1] - c->min[1]),
                   (double)(c->max[2] - c->min[2]));
        table_cell(&table, "%d", c->priority);
        table_cell(&table, "%u", c->portal_count);
        table_cell(&table, "%u", c->cluster_count);
        table_cell(&table, "%u", info_triangles(map, i));
        table_cell(&table, "%u", c->node_count);
        table_cell(&table, "%u", c->light_count);
        table_cell(&table, "%s", info_cell_flags(map, i, flags));
    }
    finish(&table, rows, " (--cells lists all)");
}

void info_print_portals(const EnfMap *map) {
    Table table = {{0}, {0}, 0, NULL, 0, 0, false};
    table_titles(&table, "#portal|name|from|to|#corners|#area, m²|#twin|flags");
    for (uint32_t i = 0; i < map->portals_count; i++) {
        const EnfPortal *p = &map->portals[i];
        char flags[96];
        table_cell(&table, "%u", i);
        table_cell(&table, "%s", enf_map_string(map, p->name));
        table_cell(&table, "%s", info_cell_name(map, p->source));
        table_cell(&table, "%s", info_cell_name(map, p->target));
        table_cell(&table, "%u", p->vertex_count);
        table_cell(&table, "%.2f", info_portal_area(map, i));
        table_cell(&table, p->twin == ENF_NONE ? "-" : "%u", p->twin);
        table_cell(&table, "%s", info_portal_flags(map, i, flags));
    }
    finish(&table, UINT32_MAX, "");
}

void info_print_materials(const EnfMap *map) {
    Table table = {{0}, {0}, 0, NULL, 0, 0, false};
    table_titles(&table, "#material|name|base colour|texture|#roughness|#metallic|flags");
    for (uint32_t i = 0; i < map->materials_count; i++) {
        const EnfMaterial *m = &map->materials[i];
        char flags[96];
        table_cell(&table, "%u", i);
        table_cell(&table, "%s", enf_map_string(map, m->name));
        table_cell(&table, "%.2f %.2f %.2f %.2f", (double)m->base_color[0], (double)m->base_color[1], (double)m->base_color[2],
                   (double)m->base_color[3]);
        if (m->texture == ENF_NONE) {
            table_cell(&table, "-");
        } else {
            const EnfImage *image = &map->images[map->textures[m->texture].image];
            table_cell(&table, "%s %u×%u", enf_map_string(map, image->name), image->width, image->height);
        }
        table_cell(&table, "%.2f", (double)m->roughness);
        table_cell(&table, "%.2f", (double)m->metallic);
        table_cell(&table, "%s", info_material_flags(map, i, flags));
    }
    finish(&table, UINT32_MAX, "");
}

void info_print_lights(const EnfMap *map) {
    static const char *const kinds[] = {"point", "spot", "directional"};
    Table table = {{0}, {0}, 0, NULL, 0, 0, false};
    table_titles(&table, "#light|name|kind|cell|#position|#colour|#range, m");
    for (uint32_t i = 0; i < map->lights_count; i++) {
        const EnfLight *l = &map->lights[i];
        table_cell(&table, "%u", i);
        table_cell(&table, "%s", enf_map_string(map, l->name));
        table_cell(&table, "%s", kinds[l->kind]);
        table_cell(&table, "%s", info_cell_name(map, l->cell));
        table_cell(&table, "%.2f %.2f %.2f", l->position[0], l->position[1], l->position[2]);
        table_cell(&table, "%.3g %.3g %.3g", (double)l->color[0], (double)l->color[1], (double)l->color[2]);
        table_cell(&table, "%.1f", (double)l->range);
    }
    finish(&table, UINT32_MAX, "");
}

static uint32_t paths_of(const EnfMap *map, uint32_t entity) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < map->paths_count; i++) {
        count += map->paths[i].entity == entity;
    }
    return count;
}

void info_print_entities(const EnfMap *map) {
    Table table = {{0}, {0}, 0, NULL, 0, 0, false};
    table_titles(&table, "#entity|name|class|cell|#position|#paths|extras");
    for (uint32_t i = 0; i < map->entities_count; i++) {
        const EnfEntity *e = &map->entities[i];
        table_cell(&table, "%u", i);
        table_cell(&table, "%s", enf_map_string(map, e->name));
        table_cell(&table, "%s", enf_map_string(map, e->classname));
        table_cell(&table, "%s", info_cell_name(map, e->cell));
        table_cell(&table, "%.2f %.2f %.2f", e->translation[0], e->translation[1], e->translation[2]);
        table_cell(&table, "%u", paths_of(map, i));
        table_cell(&table, "%s", enf_map_string(map, e->extras));
    }
    finish(&table, UINT32_MAX, "");
}
