/* The tables beside geometry: images, textures, materials, lights, cameras, entities, paths. */
#include "map/map_internal.h"

/* A side beyond this is no texture that OpenGL takes. */
#define IMAGE_SIDE_MAX 16384u

static EnfResult check_images(const EnfMapCheck *check) {
    const EnfMap *map = check->map;
    for (uint32_t i = 0; i < map->images_count; i++) {
        const EnfImage *image = &map->images[i];
        if (image->width == 0 || image->width > IMAGE_SIDE_MAX) {
            return ENF_MAP_BAD(check, images, i, width, ENF_ERROR_RANGE, "%u is not in 1..%u", image->width, IMAGE_SIDE_MAX);
        }
        if (image->height == 0 || image->height > IMAGE_SIDE_MAX) {
            return ENF_MAP_BAD(check, images, i, height, ENF_ERROR_RANGE, "%u is not in 1..%u", image->height, IMAGE_SIDE_MAX);
        }
        uint64_t bytes = UINT64_C(4) * image->width * image->height;
        if (image->byte_first > map->pixels_count || bytes > map->pixels_count - image->byte_first) {
            return ENF_MAP_BAD(check, images, i, byte_first, ENF_ERROR_INDEX, "%llu bytes from %u reach outside pixels",
                               (unsigned long long)bytes, image->byte_first);
        }
    }
    return ENF_OK;
}

/* glTF 2.0, §5.26 (sampler). */
static bool wrap_known(uint32_t wrap) {
    return wrap == 10497 || wrap == 33071 || wrap == 33648; /* repeat, clamp, mirror */
}

static EnfResult check_textures(const EnfMapCheck *check) {
    for (uint32_t i = 0; i < check->map->textures_count; i++) {
        const EnfTexture *texture = &check->map->textures[i];
        if (texture->mag_filter != 9728 && texture->mag_filter != 9729) {
            return ENF_MAP_BAD(check, textures, i, mag_filter, ENF_ERROR_RANGE, "%u is no filter", texture->mag_filter);
        }
        if (texture->min_filter != 9728 && texture->min_filter != 9729 &&
            (texture->min_filter < 9984 || texture->min_filter > 9987)) {
            return ENF_MAP_BAD(check, textures, i, min_filter, ENF_ERROR_RANGE, "%u is no filter", texture->min_filter);
        }
        if (!wrap_known(texture->wrap_s)) {
            return ENF_MAP_BAD(check, textures, i, wrap_s, ENF_ERROR_RANGE, "%u is no wrap mode", texture->wrap_s);
        }
        if (!wrap_known(texture->wrap_t)) {
            return ENF_MAP_BAD(check, textures, i, wrap_t, ENF_ERROR_RANGE, "%u is no wrap mode", texture->wrap_t);
        }
    }
    return ENF_OK;
}

static bool points_somewhere(const float v[3]) {
    return v[0] != 0.0f || v[1] != 0.0f || v[2] != 0.0f;
}

static EnfResult check_lights(const EnfMapCheck *check) {
    const EnfMap *map = check->map;
    for (uint32_t i = 0; i < map->lights_count; i++) {
        const EnfLight *light = &map->lights[i];
        if (light->kind != ENF_LIGHT_POINT && !points_somewhere(light->direction)) {
            return ENF_MAP_BAD(check, lights, i, direction, ENF_ERROR_RANGE, "is zero");
        }
        if (light->range < 0.0f) {
            return ENF_MAP_BAD(check, lights, i, range, ENF_ERROR_RANGE, "%g is negative", (double)light->range);
        }
        if (light->kind == ENF_LIGHT_SPOT &&
            (light->outer_cos < -1.0f || light->outer_cos > light->inner_cos || light->inner_cos > 1.0f)) {
            return ENF_MAP_BAD(check, lights, i, outer_cos, ENF_ERROR_RANGE,
                               "-1 <= outer_cos %g <= inner_cos %g <= 1 does not hold", (double)light->outer_cos,
                               (double)light->inner_cos);
        }
    }
    for (uint32_t i = 0; i < map->light_planes_count; i++) {
        if (!points_somewhere(map->light_planes[i].n)) {
            return ENF_MAP_BAD(check, light_planes, i, n, ENF_ERROR_RANGE, "is zero");
        }
    }
    return ENF_OK;
}

static EnfResult check_entities(const EnfMapCheck *check) {
    const EnfMap *map = check->map;
    for (uint32_t i = 0; i < map->entities_count; i++) {
        const EnfEntity *entity = &map->entities[i];
        if (entity->parent != ENF_NONE && entity->parent >= i) {
            return ENF_MAP_BAD(check, entities, i, parent, ENF_ERROR_INDEX, "%u does not come before its child",
                               entity->parent);
        }
        const float *q = entity->rotation;
        if (q[0] == 0.0f && q[1] == 0.0f && q[2] == 0.0f && q[3] == 0.0f) {
            return ENF_MAP_BAD(check, entities, i, rotation, ENF_ERROR_RANGE, "is the zero quaternion");
        }
    }
    for (uint32_t i = 0; i < map->cameras_count; i++) {
        if (map->cameras[i].fov_y < 0.0f) {
            return ENF_MAP_BAD(check, cameras, i, fov_y, ENF_ERROR_RANGE, "%g is negative", (double)map->cameras[i].fov_y);
        }
    }
    return ENF_OK;
}

/* Times and values of one path lie in path_floats, times ascending. */
static EnfResult check_path(const EnfMapCheck *check, uint32_t i) {
    const EnfMap *map = check->map;
    const EnfPath *path = &map->paths[i];
    uint64_t values = path->target == ENF_PATH_ROTATION ? 4 : 3;
    uint64_t floats = path->key_count * (1 + values * (path->kind == ENF_PATH_CUBIC ? 3 : 1));
    if (path->key_count == 0) {
        return ENF_MAP_BAD(check, paths, i, key_count, ENF_ERROR_RANGE, "is zero");
    }
    if (path->float_first > map->path_floats_count || floats > map->path_floats_count - path->float_first) {
        return ENF_MAP_BAD(check, paths, i, float_first, ENF_ERROR_INDEX, "%llu floats from %u reach outside path_floats",
                           (unsigned long long)floats, path->float_first);
    }
    const float *times = map->path_floats + path->float_first;
    for (uint32_t key = 1; key < path->key_count; key++) {
        if (!(times[key - 1] < times[key])) {
            return enf_map_bad(check, ENF_CHUNK_path_floats, &times[key], "", ENF_ERROR_RANGE,
                               "the times of path %u do not ascend at key %u", i, key);
        }
    }
    return ENF_OK;
}

EnfResult enf_map_check_tables(const EnfMapCheck *check) {
    EnfResult result = check_images(check);
    result = result ? result : check_textures(check);
    result = result ? result : check_lights(check);
    result = result ? result : check_entities(check);
    for (uint32_t i = 0; result == ENF_OK && i < check->map->paths_count; i++) {
        result = check_path(check, i);
    }
    return result;
}
