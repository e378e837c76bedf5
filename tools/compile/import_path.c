/* Animations of nodes as paths: key times and values, decoded to float. A channel that cannot be read is left out and reported:
 * the level stands without it. */
#include "compile/import.h"

#include <math.h>
#include <string.h>

static void lose(EnfImport *import, const EnfGltfChannel *channel, const char *what) {
    enf_diagnose(import->diagnosis, ENF_DIAGNOSIS_UNSUPPORTED, import->source->nodes[import->source_nodes[channel->node]].name,
                 "animation '%s', %s: %s", channel->animation, channel->path, what);
}

static bool target_of(const char *path, EnfPathTarget *out) {
    static const char *const names[] = {"translation", "rotation", "scale"};
    static const EnfPathTarget targets[] = {ENF_PATH_TRANSLATION, ENF_PATH_ROTATION, ENF_PATH_SCALE};
    for (int i = 0; i < 3; i++) {
        if (strcmp(path, names[i]) == 0) {
            *out = targets[i];
            return true;
        }
    }
    return false;
}

static EnfPathKind kind_of(const char *interpolation) {
    return strcmp(interpolation, "STEP") == 0          ? ENF_PATH_STEP
           : strcmp(interpolation, "CUBICSPLINE") == 0 ? ENF_PATH_CUBIC
                                                       : ENF_PATH_LINEAR;
}

/* Times must rise and everything must be finite. */
static bool keys_are_sound(const float *times, uint32_t key_count, const float *values, size_t value_count) {
    for (uint32_t i = 0; i < key_count; i++) {
        if (!isfinite(times[i]) || times[i] < 0.0f || (i > 0 && times[i] <= times[i - 1])) {
            return false;
        }
    }
    for (size_t i = 0; i < value_count; i++) {
        if (!isfinite(values[i])) {
            return false;
        }
    }
    return true;
}

static EnfResult read_keys(EnfImport *import, const EnfGltfChannel *channel, EnfSourcePath *path, bool *sound) {
    const EnfGltfAccessor *input = &import->gltf.accessors[channel->input], *output = &import->gltf.accessors[channel->output];
    uint32_t components = path->target == ENF_PATH_ROTATION ? 4 : 3;
    uint64_t rows = input->count * (path->kind == ENF_PATH_CUBIC ? 3 : 1);
    *sound = input->count > 0 && input->components == 1 && output->components == components && output->count >= rows &&
             rows <= UINT32_MAX;
    if (!*sound) {
        return ENF_OK;
    }
    path->key_count = (uint32_t)input->count;
    float *times = enf_import_keep(import, path->key_count, sizeof *times);
    float *values = enf_import_keep(import, (size_t)rows, components * sizeof *values);
    if (!times || !values) {
        return import->failure;
    }
    EnfResult result = enf_import_floats(import, channel->input, (EnfImportRange){0, path->key_count}, 1, times);
    if (result == ENF_OK) {
        result = enf_import_floats(import, channel->output, (EnfImportRange){0, (uint32_t)rows}, components, values);
    }
    *sound = result == ENF_OK && keys_are_sound(times, path->key_count, values, (size_t)rows * components);
    path->times = times;
    path->values = values;
    return result;
}

static EnfResult add_path(EnfImport *import, const EnfGltfChannel *channel, EnfSourcePath *path, bool *added) {
    *added = false;
    *path = (EnfSourcePath){0};
    path->node = import->source_nodes[channel->node];
    if (path->node == ENF_NONE) {
        return ENF_OK; /* not in the scene */
    }
    if (!target_of(channel->path, &path->target)) {
        lose(import, channel, "is not supported");
        return ENF_OK;
    }
    path->kind = kind_of(channel->interpolation);
    path->animation = enf_import_text(import, channel->animation);
    if (!path->animation) {
        return import->failure;
    }
    EnfResult result = read_keys(import, channel, path, added);
    if (result == ENF_OK && !*added) {
        lose(import, channel, "its keys are malformed; it is left out");
    }
    return result;
}

EnfResult enf_import_paths(EnfImport *import) {
    const EnfGltf *gltf = &import->gltf;
    EnfSourcePath *paths = enf_import_keep(import, gltf->channel_count, sizeof *paths);
    if (!paths) {
        return import->failure;
    }
    uint32_t count = 0;
    for (uint32_t i = 0; i < gltf->channel_count; i++) {
        bool added;
        EnfResult result = add_path(import, &gltf->channels[i], &paths[count], &added);
        if (result != ENF_OK) {
            return result;
        }
        count += added;
    }
    import->source->paths = paths;
    import->source->path_count = count;
    return ENF_OK;
}
