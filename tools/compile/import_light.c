/* Lights and cameras: values as the file gives them, made finite and put in order. */
#include "compile/import.h"

#include <string.h>

static float limited(double value, double low, double high) {
    return (float)(value < low ? low : value > high ? high : value);
}

static EnfLightKind kind_of(EnfImport *import, const EnfGltfLight *from) {
    if (strcmp(from->type, "directional") == 0) {
        return ENF_LIGHT_DIRECTIONAL;
    }
    if (strcmp(from->type, "spot") == 0) {
        return ENF_LIGHT_SPOT;
    }
    if (strcmp(from->type, "point") != 0) {
        enf_diagnose(import->diagnosis, ENF_DIAGNOSIS_UNSUPPORTED, "",
                     "light '%s' of unknown type '%s' is taken as a point light", from->name, from->type);
    }
    return ENF_LIGHT_POINT;
}

static EnfResult read_lights(EnfImport *import) {
    const EnfGltf *gltf = &import->gltf;
    EnfSourceLight *lights = enf_import_keep(import, gltf->light_count, sizeof *lights);
    if (!lights) {
        return import->failure;
    }
    for (uint32_t i = 0; i < gltf->light_count; i++) {
        const EnfGltfLight *from = &gltf->lights[i];
        EnfSourceLight *to = &lights[i];
        to->name = enf_import_text(import, from->name);
        if (!to->name) {
            return import->failure;
        }
        to->kind = kind_of(import, from);
        for (int c = 0; c < 3; c++) {
            to->color[c] = limited(from->color[c], 0.0, 1e6);
        }
        to->intensity = limited(from->intensity, 0.0, 1e9);
        to->range = limited(from->range, 0.0, 1e6);
        to->outer = limited(from->outer, 0.0, ENF_PI / 2.0);
        to->inner = limited(from->inner, 0.0, (double)to->outer);
    }
    import->source->lights = lights;
    import->source->light_count = gltf->light_count;
    return ENF_OK;
}

static EnfMapCamera camera_of(const EnfGltfCamera *from) {
    if (!from->perspective) {
        return (EnfMapCamera){(float)(ENF_PI / 3.0), 0.0f, 0.1f, 0.0f};
    }
    return (EnfMapCamera){limited(from->fov_y, 0.01, 3.1), limited(from->aspect, 0.0, 1e3),
                          limited(from->near_plane, 1e-6, 1e6), limited(from->far_plane, 0.0, 1e9)};
}

EnfResult enf_import_lights(EnfImport *import) {
    const EnfGltf *gltf = &import->gltf;
    EnfMapCamera *cameras = enf_import_keep(import, gltf->camera_count, sizeof *cameras);
    if (!cameras) {
        return import->failure;
    }
    for (uint32_t i = 0; i < gltf->camera_count; i++) {
        cameras[i] = camera_of(&gltf->cameras[i]);
        if (!gltf->cameras[i].perspective) {
            enf_diagnose(import->diagnosis, ENF_DIAGNOSIS_UNSUPPORTED, "",
                         "camera %u is orthographic; taken as one of 60 degrees", i);
        }
    }
    import->source->cameras = cameras;
    import->source->camera_count = gltf->camera_count;
    return read_lights(import);
}
