/* The tables of gltf_schema.h, after the specification (Khronos, glTF 2.0, chapter 5) and the texts of the extensions. Only what
 * the importer reads stands here: a defect elsewhere in a file does no harm. */
#include "compile/gltf_schema.h"

#include <stddef.h>

/* One line a member: MAY where the specification gives a default, MUST where it does not. */
#define MAY(key, kind)                                                                                                         \
    { key, ENF_GLTF_##kind, false, 0, NULL, NULL }
#define MUST(key, kind)                                                                                                        \
    { key, ENF_GLTF_##kind, true, 0, NULL, NULL }
#define MAY_LIST(key, count)                                                                                                   \
    { key, ENF_GLTF_NUMBER_LIST, false, count, NULL, NULL }
#define MUST_WORD(key, words)                                                                                                  \
    { key, ENF_GLTF_WORD, true, 0, NULL, words }
#define MAY_POINT(key, collection)                                                                                             \
    { key, ENF_GLTF_INDEX, false, ENF_GLTF_##collection, NULL, NULL }
#define MUST_POINT(key, collection)                                                                                            \
    { key, ENF_GLTF_INDEX, true, ENF_GLTF_##collection, NULL, NULL }
#define MAY_POINT_LIST(key, collection)                                                                                        \
    { key, ENF_GLTF_INDEX_LIST, false, ENF_GLTF_##collection, NULL, NULL }
#define MUST_POINT_MAP(key, collection)                                                                                        \
    { key, ENF_GLTF_INDEX_MAP, true, ENF_GLTF_##collection, NULL, NULL }
#define MAY_HOLD(key, table)                                                                                                   \
    { key, ENF_GLTF_OBJECT, false, 0, table, NULL }
#define MUST_HOLD(key, table)                                                                                                  \
    { key, ENF_GLTF_OBJECT, true, 0, table, NULL }
#define MAY_HOLD_LIST(key, table)                                                                                              \
    { key, ENF_GLTF_OBJECT_LIST, false, 0, table, NULL }
#define MUST_HOLD_LIST(key, table)                                                                                             \
    { key, ENF_GLTF_OBJECT_LIST, true, 0, table, NULL }
#define END                                                                                                                    \
    { NULL, ENF_GLTF_STRING, false, 0, NULL, NULL }

#define TABLE(name) static const EnfGltfRule name[]

const char *const enf_gltf_extensions[] = {
    "KHR_lights_punctual",
    "KHR_texture_transform",
    "KHR_materials_unlit",
    "KHR_materials_emissive_strength",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_mesh_quantization",
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "OMI_spawn_point",
    NULL,
};

/* ---- bytes ------------------------------------------------------------------------------------------------------ */

TABLE(buffer) = {MUST("byteLength", COUNT), MAY("uri", STRING), END};

TABLE(meshopt) = {
    MUST_POINT("buffer", BUFFERS), MAY("byteOffset", COUNT), MUST("byteLength", COUNT), MUST("byteStride", COUNT),
    MUST("count", COUNT),          MUST("mode", STRING),     MAY("filter", STRING),     END,
};
TABLE(view_extensions) = {MAY_HOLD("EXT_meshopt_compression", meshopt), END};
TABLE(view) = {
    MUST_POINT("buffer", BUFFERS),
    MAY("byteOffset", COUNT),
    MUST("byteLength", COUNT),
    MAY("byteStride", STRIDE),
    MAY_HOLD("extensions", view_extensions),
    END,
};

TABLE(sparse_indices) = {
    MUST_POINT("bufferView", VIEWS),
    MAY("byteOffset", COUNT),
    MUST("componentType", COUNT),
    END,
};
TABLE(sparse_values) = {MUST_POINT("bufferView", VIEWS), MAY("byteOffset", COUNT), END};
TABLE(sparse) = {
    MUST("count", COUNT),
    MUST_HOLD("indices", sparse_indices),
    MUST_HOLD("values", sparse_values),
    END,
};
static const char *const element_types[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4", NULL};
TABLE(accessor) = {
    MAY_POINT("bufferView", VIEWS), MAY("byteOffset", COUNT),         MUST("componentType", COUNT), MAY("normalized", BOOLEAN),
    MUST("count", COUNT),           MUST_WORD("type", element_types), MAY_HOLD("sparse", sparse),   END,
};

/* ---- shapes and places ------------------------------------------------------------------------------------------ */

TABLE(primitive) = {
    MUST_POINT_MAP("attributes", ACCESSORS),
    MAY_POINT("indices", ACCESSORS),
    MAY_POINT("material", MATERIALS),
    MAY("mode", COUNT),
    END,
};
TABLE(mesh) = {MAY("name", STRING), MUST_HOLD_LIST("primitives", primitive), END};

TABLE(light_reference) = {MUST_POINT("light", LIGHTS), END};
TABLE(instancing) = {MUST_POINT_MAP("attributes", ACCESSORS), END};
TABLE(node_extensions) = {
    MAY_HOLD("KHR_lights_punctual", light_reference),
    MAY_HOLD("EXT_mesh_gpu_instancing", instancing),
    END,
};
TABLE(node) = {
    MAY("name", STRING),
    MAY_POINT_LIST("children", NODES),
    MAY_POINT("mesh", MESHES),
    MAY_POINT("camera", CAMERAS),
    MAY_LIST("matrix", 16),
    MAY_LIST("translation", 3),
    MAY_LIST("rotation", 4),
    MAY_LIST("scale", 3),
    MAY_HOLD("extensions", node_extensions),
    END,
};
TABLE(scene) = {MAY_POINT_LIST("nodes", NODES), END};

/* ---- looks ------------------------------------------------------------------------------------------------------ */

TABLE(transform) = {
    MAY_LIST("offset", 2), MAY("rotation", NUMBER), MAY_LIST("scale", 2), MAY("texCoord", COUNT), END,
};
TABLE(texture_info_extensions) = {MAY_HOLD("KHR_texture_transform", transform), END};
TABLE(texture_info) = {
    MUST_POINT("index", TEXTURES),
    MAY("texCoord", COUNT),
    MAY_HOLD("extensions", texture_info_extensions),
    END,
};
TABLE(roughness) = {
    MAY_LIST("baseColorFactor", 4),
    MAY_HOLD("baseColorTexture", texture_info),
    MAY("metallicFactor", NUMBER),
    MAY("roughnessFactor", NUMBER),
    END,
};
TABLE(glossiness) = {
    MAY_LIST("diffuseFactor", 4),
    MAY_HOLD("diffuseTexture", texture_info),
    MAY("glossinessFactor", NUMBER),
    END,
};
TABLE(strength) = {MAY("emissiveStrength", NUMBER), END};
TABLE(material_extensions) = {
    MAY_HOLD("KHR_materials_emissive_strength", strength),
    MAY_HOLD("KHR_materials_pbrSpecularGlossiness", glossiness),
    END,
};
TABLE(material) = {
    MAY("name", STRING),
    MAY_HOLD("pbrMetallicRoughness", roughness),
    MAY_LIST("emissiveFactor", 3),
    MAY_HOLD("emissiveTexture", texture_info),
    MAY("alphaMode", STRING),
    MAY("alphaCutoff", NUMBER),
    MAY("doubleSided", BOOLEAN),
    MAY_HOLD("extensions", material_extensions),
    END,
};
TABLE(texture) = {MAY_POINT("source", IMAGES), MAY_POINT("sampler", SAMPLERS), END};
TABLE(sampler) = {
    MAY("magFilter", COUNT), MAY("minFilter", COUNT), MAY("wrapS", COUNT), MAY("wrapT", COUNT), END,
};
TABLE(image) = {MAY("uri", STRING), MAY_POINT("bufferView", VIEWS), MAY("name", STRING), END};

TABLE(spot) = {MAY("innerConeAngle", NUMBER), MAY("outerConeAngle", NUMBER), END};
TABLE(light) = {
    MAY("name", STRING),
    MUST("type", STRING),
    MAY_LIST("color", 3),
    MAY("intensity", NUMBER),
    MAY("range", NUMBER),
    MAY_HOLD("spot", spot),
    END,
};
TABLE(lights) = {MAY_HOLD_LIST("lights", light), END};

/* ---- eyes and movement ------------------------------------------------------------------------------------------ */

const char *const enf_gltf_camera_types[] = {"perspective", "orthographic", NULL};
TABLE(perspective) = {
    MUST("yfov", NUMBER), MUST("znear", NUMBER), MAY("aspectRatio", NUMBER), MAY("zfar", NUMBER), END,
};
TABLE(orthographic) = {
    MUST("xmag", NUMBER), MUST("ymag", NUMBER), MUST("znear", NUMBER), MUST("zfar", NUMBER), END,
};
TABLE(camera) = {
    MUST_WORD("type", enf_gltf_camera_types),
    MAY_HOLD("perspective", perspective),
    MAY_HOLD("orthographic", orthographic),
    END,
};

TABLE(target) = {MAY_POINT("node", NODES), MUST("path", STRING), END};
TABLE(channel) = {MUST("sampler", COUNT), MUST_HOLD("target", target), END};
TABLE(animation_sampler) = {
    MUST_POINT("input", ACCESSORS),
    MUST_POINT("output", ACCESSORS),
    MAY("interpolation", STRING),
    END,
};
TABLE(animation) = {
    MAY("name", STRING),
    MUST_HOLD_LIST("channels", channel),
    MUST_HOLD_LIST("samplers", animation_sampler),
    END,
};

/* ---- the document ----------------------------------------------------------------------------------------------- */

TABLE(asset) = {MUST("version", STRING), MAY("minVersion", STRING), MAY("generator", STRING), END};
TABLE(root_extensions) = {MAY_HOLD("KHR_lights_punctual", lights), END};

const EnfGltfRule enf_gltf_root_table[] = {
    MUST_HOLD("asset", asset),
    MAY("extensionsUsed", STRING_LIST),
    MAY("extensionsRequired", STRING_LIST),
    MAY_HOLD_LIST("buffers", buffer),
    MAY_HOLD_LIST("bufferViews", view),
    MAY_HOLD_LIST("accessors", accessor),
    MAY_HOLD_LIST("meshes", mesh),
    MAY_HOLD_LIST("nodes", node),
    MAY_HOLD_LIST("scenes", scene),
    MAY_POINT("scene", SCENES),
    MAY_HOLD_LIST("materials", material),
    MAY_HOLD_LIST("textures", texture),
    MAY_HOLD_LIST("images", image),
    MAY_HOLD_LIST("samplers", sampler),
    MAY_HOLD_LIST("cameras", camera),
    MAY_HOLD_LIST("animations", animation),
    MAY_HOLD("extensions", root_extensions),
    END,
};
