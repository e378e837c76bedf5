/* The overlay: glTF 2.0 written by hand, one JSON chunk (cJSON) and one buffer of float positions and 32-bit indices. */
#include "compile/overlay_glb.h"

#include "compile/array.h"

#include <cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MODE_LINES = 1,
    MODE_TRIANGLES = 4,
    TYPE_FLOAT = 5126,
    TYPE_UINT = 5125,
    TARGET_VERTICES = 34962,
    TARGET_INDICES = 34963
};

/* Half the width of the cross that marks a point, metres. */
#define CROSS 0.25

typedef enum Paint { PAINT_PORTAL, PAINT_LINK, PAINT_WARNING, PAINT_ERROR, PAINT_PATH, PAINT_COUNT } Paint;
static const struct {
    const char *name;
    double color[4];
} paints[PAINT_COUNT] = {[PAINT_PORTAL] = {"portal", {0.05, 0.6, 0.55, 0.4}},
                         [PAINT_LINK] = {"portal closed or far", {0.3, 0.25, 0.7, 0.4}},
                         [PAINT_WARNING] = {"warning", {1.0, 0.45, 0.05, 0.7}},
                         [PAINT_ERROR] = {"error", {0.9, 0.05, 0.05, 0.8}},
                         [PAINT_PATH] = {"leak path", {1.0, 0.0, 0.6, 1.0}}};

typedef struct Overlay {
    ENF_ARRAY(uint8_t) bytes;
    cJSON *root, *nodes, *meshes, *accessors, *views, *roots;
    uint32_t node_count, mesh_count, accessor_count, view_count;
    bool failed;
} Overlay;

/* ---- JSON ------------------------------------------------------------------------------------------------------- */

static cJSON *add_object(Overlay *overlay, cJSON *array) {
    cJSON *object = cJSON_CreateObject();
    if (!object || !cJSON_AddItemToArray(array, object)) {
        cJSON_Delete(object);
        overlay->failed = true;
        return NULL;
    }
    return object;
}

static void add_numbers(cJSON *object, const char *key, const double *numbers, int count) {
    cJSON *array = cJSON_CreateDoubleArray(numbers, count);
    cJSON_AddItemToObject(object, key, array);
}

static bool start(Overlay *overlay) {
    memset(overlay, 0, sizeof *overlay);
    overlay->root = cJSON_CreateObject();
    cJSON *asset = cJSON_AddObjectToObject(overlay->root, "asset");
    cJSON_AddStringToObject(asset, "version", "2.0");
    cJSON_AddStringToObject(asset, "generator", "Enfilade enfc " ENF_VERSION);
    cJSON_AddNumberToObject(overlay->root, "scene", 0);
    cJSON *scene = add_object(overlay, cJSON_AddArrayToObject(overlay->root, "scenes"));
    overlay->roots = cJSON_AddArrayToObject(scene, "nodes");
    overlay->nodes = cJSON_AddArrayToObject(overlay->root, "nodes");
    cJSON *materials = cJSON_AddArrayToObject(overlay->root, "materials");
    for (int i = 0; i < PAINT_COUNT; i++) {
        cJSON *material = add_object(overlay, materials);
        cJSON_AddStringToObject(material, "name", paints[i].name);
        cJSON_AddStringToObject(material, "alphaMode", "BLEND");
        cJSON_AddBoolToObject(material, "doubleSided", true);
        cJSON *pbr = cJSON_AddObjectToObject(material, "pbrMetallicRoughness");
        add_numbers(pbr, "baseColorFactor", paints[i].color, 4);
        cJSON_AddNumberToObject(pbr, "metallicFactor", 0);
        add_numbers(material, "emissiveFactor", paints[i].color, 3);
    }
    overlay->failed = overlay->failed || !overlay->roots || !overlay->nodes;
    return !overlay->failed;
}

/* ---- geometry --------------------------------------------------------------------------------------------------- */

/* Appends bytes as a buffer view; returns its number. */
static uint32_t add_view(Overlay *overlay, const void *data, size_t size, int target) {
    if (!ENF_ARRAY_ROOM(&overlay->bytes, size)) {
        overlay->failed = true;
        return 0;
    }
    cJSON *view = add_object(overlay, overlay->views);
    cJSON_AddNumberToObject(view, "buffer", 0);
    cJSON_AddNumberToObject(view, "byteOffset", overlay->bytes.count);
    cJSON_AddNumberToObject(view, "byteLength", (double)size);
    cJSON_AddNumberToObject(view, "target", target);
    memcpy(overlay->bytes.data + overlay->bytes.count, data, size);
    overlay->bytes.count += (uint32_t)size;
    return overlay->view_count++;
}

static cJSON *add_accessor(Overlay *overlay, uint32_t view, int type, uint32_t count, const char *shape) {
    cJSON *accessor = add_object(overlay, overlay->accessors);
    cJSON_AddNumberToObject(accessor, "bufferView", view);
    cJSON_AddNumberToObject(accessor, "componentType", type);
    cJSON_AddNumberToObject(accessor, "count", count);
    cJSON_AddStringToObject(accessor, "type", shape);
    overlay->accessor_count++;
    return accessor;
}

static void add_positions(Overlay *overlay, const EnfVec3 *points, uint32_t count) {
    float *packed = malloc((size_t)count * 3 * sizeof *packed);
    if (!packed) {
        overlay->failed = true;
        return;
    }
    double low[3] = {0}, high[3] = {0};
    for (uint32_t i = 0; i < count; i++) {
        const double p[3] = {points[i].x, points[i].y, points[i].z};
        for (int axis = 0; axis < 3; axis++) {
            packed[3 * i + (uint32_t)axis] = (float)p[axis];
            double c = (double)(float)p[axis];
            low[axis] = i == 0 || c < low[axis] ? c : low[axis];
            high[axis] = i == 0 || c > high[axis] ? c : high[axis];
        }
    }
    uint32_t view = add_view(overlay, packed, (size_t)count * 3 * sizeof *packed, TARGET_VERTICES);
    cJSON *accessor = add_accessor(overlay, view, TYPE_FLOAT, count, "VEC3");
    add_numbers(accessor, "min", low, 3);
    add_numbers(accessor, "max", high, 3);
    free(packed);
}

/* What is drawn of a thing. */
typedef struct Shape {
    const EnfVec3 *points;
    const uint32_t *indices;
    uint32_t point_count, index_count;
    int mode;
    Paint paint;
} Shape;

/* A mesh of one primitive; returns its number. */
static uint32_t add_mesh(Overlay *overlay, const char *name, const Shape *shape) {
    add_positions(overlay, shape->points, shape->point_count);
    uint32_t positions = overlay->accessor_count - 1;
    uint32_t view = add_view(overlay, shape->indices, shape->index_count * sizeof *shape->indices, TARGET_INDICES);
    add_accessor(overlay, view, TYPE_UINT, shape->index_count, "SCALAR");
    cJSON *mesh = add_object(overlay, overlay->meshes);
    cJSON_AddStringToObject(mesh, "name", name);
    cJSON *primitive = add_object(overlay, cJSON_AddArrayToObject(mesh, "primitives"));
    cJSON_AddNumberToObject(cJSON_AddObjectToObject(primitive, "attributes"), "POSITION", positions);
    cJSON_AddNumberToObject(primitive, "indices", positions + 1);
    cJSON_AddNumberToObject(primitive, "mode", shape->mode);
    cJSON_AddNumberToObject(primitive, "material", shape->paint);
    return overlay->mesh_count++;
}

/* A node, with a mesh unless `mesh` is ENF_NONE; returns its number. */
static uint32_t add_node(Overlay *overlay, cJSON *parent, const char *name, uint32_t mesh) {
    cJSON *node = add_object(overlay, overlay->nodes);
    cJSON_AddStringToObject(node, "name", name);
    if (mesh != ENF_NONE) {
        cJSON_AddNumberToObject(node, "mesh", mesh);
    }
    cJSON_AddItemToArray(parent, cJSON_CreateNumber(overlay->node_count));
    return overlay->node_count++;
}

/* ---- shapes ----------------------------------------------------------------------------------------------------- */

static void add_polygon(Overlay *overlay, cJSON *parent, const char *name, const EnfVec3 *points, uint32_t count, Paint paint) {
    uint32_t *indices = malloc((size_t)count * 3 * sizeof *indices);
    if (!indices) {
        overlay->failed = true;
        return;
    }
    uint32_t made = 0;
    for (uint32_t i = 1; i + 1 < count; i++) {
        indices[made++] = 0;
        indices[made++] = i;
        indices[made++] = i + 1;
    }
    uint32_t mesh = add_mesh(overlay, name, &(Shape){points, indices, count, made, MODE_TRIANGLES, paint});
    add_node(overlay, parent, name, mesh);
    free(indices);
}

static void add_polyline(Overlay *overlay, cJSON *parent, const char *name, const EnfVec3 *points, uint32_t count) {
    uint32_t *indices = malloc((size_t)count * 2 * sizeof *indices);
    if (!indices) {
        overlay->failed = true;
        return;
    }
    for (uint32_t i = 0; i + 1 < count; i++) {
        indices[2 * i] = i;
        indices[2 * i + 1] = i + 1;
    }
    uint32_t mesh = add_mesh(overlay, name, &(Shape){points, indices, count, 2 * (count - 1), MODE_LINES, PAINT_PATH});
    add_node(overlay, parent, name, mesh);
    free(indices);
}

static void add_cross(Overlay *overlay, cJSON *parent, const char *name, EnfVec3 p) {
    static const uint32_t indices[6] = {0, 1, 2, 3, 4, 5};
    const EnfVec3 points[6] = {{p.x - CROSS, p.y, p.z}, {p.x + CROSS, p.y, p.z}, {p.x, p.y - CROSS, p.z},
                               {p.x, p.y + CROSS, p.z}, {p.x, p.y, p.z - CROSS}, {p.x, p.y, p.z + CROSS}};
    const Shape shape = {points, indices, 6, 6, MODE_LINES, PAINT_WARNING};
    add_node(overlay, parent, name, add_mesh(overlay, name, &shape));
}

/* ---- content ---------------------------------------------------------------------------------------------------- */

static void add_portals(Overlay *overlay, const EnfLayout *layout, cJSON *parent) {
    EnfVec3 points[ENF_POLYGON_MAX];
    for (uint32_t i = 0; i < layout->portal_count && !overlay->failed; i++) {
        const EnfLayoutPortal *portal = &layout->portals[i];
        bool second = portal->twin != ENF_NONE && portal->twin < i && !portal->has_transform;
        if (second || portal->point_count < 3 || portal->point_count > ENF_POLYGON_MAX) {
            continue;
        }
        for (uint32_t k = 0; k < portal->point_count; k++) {
            points[k] = enf_grid_point(layout->points[portal->point_first + k]);
        }
        bool plain = !portal->has_transform && !(portal->flags & ENF_PORTAL_CLOSED);
        add_polygon(overlay, parent, portal->name, points, portal->point_count, plain ? PAINT_PORTAL : PAINT_LINK);
    }
}

static void add_findings(Overlay *overlay, const EnfDiagnosis *diagnosis, cJSON *parent) {
    for (uint32_t i = 0; i < diagnosis->count && !overlay->failed; i++) {
        const EnfFinding *finding = &diagnosis->findings[i];
        char name[256];
        snprintf(name, sizeof name, "%s: %.200s", enf_diagnosis_text(finding->code), finding->node);
        bool line = finding->code == ENF_DIAGNOSIS_ROOM_LEAK;
        Paint paint = enf_diagnosis_is_error(finding->code) ? PAINT_ERROR : PAINT_WARNING;
        if (finding->point_count == 1) {
            add_cross(overlay, parent, name, finding->points[0]);
        } else if (line || finding->point_count == 2) {
            if (finding->point_count > 1) {
                add_polyline(overlay, parent, name, finding->points, finding->point_count);
            }
        } else if (finding->point_count > 2) {
            add_polygon(overlay, parent, name, finding->points, finding->point_count, paint);
        }
    }
}

/* ---- the file --------------------------------------------------------------------------------------------------- */

static void put_u32(uint8_t *at, uint32_t value) {
    for (int i = 0; i < 4; i++) {
        at[i] = (uint8_t)(value >> (8 * i));
    }
}

static EnfResult save(const Overlay *overlay, const char *path, EnfError *error) {
    char *json = cJSON_PrintUnformatted(overlay->root);
    if (!json) {
        return enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory for the overlay");
    }
    size_t json_size = strlen(json), json_padded = (json_size + 3) / 4 * 4;
    uint32_t bytes = overlay->bytes.count;
    uint8_t head[20], body[8];
    put_u32(head, 0x46546c67);
    put_u32(head + 4, 2);
    put_u32(head + 8, (uint32_t)(20 + json_padded) + (bytes ? 8 + bytes : 0));
    put_u32(head + 12, (uint32_t)json_padded);
    put_u32(head + 16, 0x4e4f534a);
    put_u32(body, bytes);
    put_u32(body + 4, 0x004e4942);
    const EnfSpan spans[5] = {{head, sizeof head},
                              {json, json_size},
                              {"   ", json_padded - json_size},
                              {body, bytes ? sizeof body : 0},
                              {overlay->bytes.data, bytes}};
    EnfResult result = enf_file_write(path, spans, bytes ? 5 : 3, error);
    cJSON_free(json);
    return result;
}

/* glTF forbids empty arrays and buffers: what is empty is left out. */
static void attach(Overlay *overlay, const char *key, cJSON *array) {
    if (cJSON_GetArraySize(array) > 0) {
        cJSON_AddItemToObject(overlay->root, key, array);
    } else {
        cJSON_Delete(array);
    }
}

static void add_group(Overlay *overlay, const char *name, cJSON *children) {
    uint32_t number = add_node(overlay, overlay->roots, name, ENF_NONE);
    if (cJSON_GetArraySize(children) > 0) {
        cJSON_AddItemToObject(cJSON_GetArrayItem(overlay->nodes, (int)number), "children", children);
    } else {
        cJSON_Delete(children);
    }
}

EnfResult enf_overlay_write(const char *path, const EnfLayout *layout, const EnfDiagnosis *diagnosis, EnfError *error) {
    Overlay overlay;
    EnfResult result = ENF_OK;
    start(&overlay);
    overlay.meshes = cJSON_CreateArray();
    overlay.accessors = cJSON_CreateArray();
    overlay.views = cJSON_CreateArray();
    cJSON *portals = cJSON_CreateArray(), *findings = cJSON_CreateArray();
    add_portals(&overlay, layout, portals);
    add_findings(&overlay, diagnosis, findings);
    add_group(&overlay, "portals", portals);
    add_group(&overlay, "findings", findings);
    attach(&overlay, "meshes", overlay.meshes);
    attach(&overlay, "accessors", overlay.accessors);
    attach(&overlay, "bufferViews", overlay.views);
    if (overlay.bytes.count > 0) {
        cJSON *buffer = add_object(&overlay, cJSON_AddArrayToObject(overlay.root, "buffers"));
        cJSON_AddNumberToObject(buffer, "byteLength", overlay.bytes.count);
    }
    if (overlay.failed) {
        result = enf_error_set(error, ENF_ERROR_MEMORY, UINT64_MAX, "out of memory for the overlay");
    } else {
        result = save(&overlay, path, error);
    }
    cJSON_Delete(overlay.root);
    free(overlay.bytes.data);
    return result;
}
