/* What a glTF text must look like before tinygltf may see it: types, ranges and every index that we use. */
#ifndef ENFILADE_COMPILE_GLTF_CHECK_H
#define ENFILADE_COMPILE_GLTF_CHECK_H

#include "compile/diagnosis.h"
#include "compile/json.h"

/** Checks `json` against the tables of gltf_check.c: whatever the importer reads has its type, its required members, and
 *  indices inside their arrays; what it does not read is not looked at. Unknown extensionsRequired are refused by name
 *  (ENF_ERROR_UNSUPPORTED), other versions than 2 too (ENF_ERROR_VERSION); other faults are ENF_ERROR_FORMAT, ENF_ERROR_INDEX or
 *  ENF_ERROR_RANGE with JSON path and byte offset. Unknown extensionsUsed become findings. */
EnfResult enf_gltf_check(const EnfJson *json, EnfDiagnosis *diagnosis, EnfError *error);

/** The text for tinygltf: buffers, images, skins, extras and bounds replaced by zeros (we read those ourselves, or not at all), and every accessor
 *  without a buffer view given one that stands for none (tinygltf refuses such indices). `*view_count` receives the number of
 *  the file's own views. Free `*text` with enf_free(NULL, *text, *size, 1). Errors: ENF_ERROR_MEMORY. */
EnfResult enf_gltf_fence(const EnfJson *json, char **text, size_t *size, uint32_t *view_count, EnfError *error);

#endif
