/* Normals where a level gives none, or bad ones. */
#ifndef ENFILADE_COMPILE_IMPORT_NORMALS_H
#define ENFILADE_COMPILE_IMPORT_NORMALS_H

#include "compile/import.h"

/* Flat normals (glTF 2.0, section 3.7.2.1: what a file without normals means). Vertices are split where faces meet at an angle;
 * coplanar neighbours keep sharing them. Replaces positions, uvs, colours and indices of `primitive`. */
EnfResult enf_import_flat_normals(EnfImport *import, EnfSourcePrimitive *primitive);

/* Makes `normals` (3 a vertex of `primitive`) unit length; zero or non-finite ones become the mean of the faces around. */
EnfResult enf_import_mend_normals(EnfImport *import, const EnfSourcePrimitive *primitive, float *normals);

#endif
