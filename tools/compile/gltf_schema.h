/* The schema of glTF 2.0 as far as the importer reads it, as tables (gltf_schema.c) for one walk (gltf_check.c). */
#ifndef ENFILADE_COMPILE_GLTF_SCHEMA_H
#define ENFILADE_COMPILE_GLTF_SCHEMA_H

#include <stdbool.h>

/** The arrays that indices point into: X(NAME, key). */
#define ENF_GLTF_COLLECTIONS(X)                                                                                                \
    X(BUFFERS, "buffers")                                                                                                      \
    X(VIEWS, "bufferViews")                                                                                                    \
    X(ACCESSORS, "accessors")                                                                                                  \
    X(MESHES, "meshes")                                                                                                        \
    X(NODES, "nodes")                                                                                                          \
    X(SCENES, "scenes")                                                                                                        \
    X(MATERIALS, "materials")                                                                                                  \
    X(TEXTURES, "textures")                                                                                                    \
    X(IMAGES, "images")                                                                                                        \
    X(SAMPLERS, "samplers")                                                                                                    \
    X(CAMERAS, "cameras")                                                                                                      \
    X(LIGHTS, "lights") /* of KHR_lights_punctual */

typedef enum EnfGltfCollection {
#define ENF_GLTF_COLLECTION_ENUM(name, key) ENF_GLTF_##name,
    ENF_GLTF_COLLECTIONS(ENF_GLTF_COLLECTION_ENUM)
#undef ENF_GLTF_COLLECTION_ENUM
        ENF_GLTF_COLLECTION_COUNT
} EnfGltfCollection;

typedef enum EnfGltfKind {
    ENF_GLTF_STRING,
    ENF_GLTF_STRING_LIST,
    ENF_GLTF_WORD, /**< a string out of `words` */
    ENF_GLTF_BOOLEAN,
    ENF_GLTF_NUMBER,
    ENF_GLTF_NUMBER_LIST, /**< of `argument` numbers */
    ENF_GLTF_COUNT,       /**< an integer from 0 to 2^31 - 1 */
    ENF_GLTF_STRIDE,      /**< a multiple of 4 up to 252 (tinygltf takes no other) */
    ENF_GLTF_INDEX,       /**< into the collection `argument` */
    ENF_GLTF_INDEX_LIST,
    ENF_GLTF_INDEX_MAP,  /**< an object whose members are indices */
    ENF_GLTF_OBJECT,     /**< of `table` */
    ENF_GLTF_OBJECT_LIST /**< an array of them */
} EnfGltfKind;

typedef struct EnfGltfRule {
    const char *key; /**< NULL ends a table */
    EnfGltfKind kind;
    bool required;
    int argument;
    const struct EnfGltfRule *table;
    const char *const *words;
} EnfGltfRule;

/** The document. `asset` and the two lists of extensions come first in it: what they say explains the rest. */
extern const EnfGltfRule enf_gltf_root_table[];
/** The types of cameras, which also name the member that holds their numbers; NULL ends it. */
extern const char *const enf_gltf_camera_types[];
/** What a level may require; NULL ends it (DESIGN section 6). */
extern const char *const enf_gltf_extensions[];

#endif
