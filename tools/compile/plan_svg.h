/* The floor plan: cells and portals seen from above, a panel a storey, as an SVG file. */
#ifndef ENFILADE_COMPILE_PLAN_SVG_H
#define ENFILADE_COMPILE_PLAN_SVG_H

#include "compile/soup.h"

/** Writes the plan atomically. `title` names the level. Byte-identical for equal input. */
EnfResult enf_plan_write(const char *path, const char *title, const EnfLayout *layout, const EnfSoup *soup, EnfError *error);

#endif
