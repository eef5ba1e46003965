/* vtk.h: a run as VTK files for ParaView: a list of times with two or three files for each row. Tested by
 * tests/extra/test_export.sh, which reads the files with VTK.
 *
 *     FOLDER/NAME.pvd              the times; open this one
 *     FOLDER/NAME-bodies-0000.vtp  each fish as a line of its bound vortices and as an outline
 *     FOLDER/NAME-wakes-0000.vtp   the free vortices, in rows with a wake
 *     FOLDER/NAME-walls-0000.vtp   the walls as lines, in all rows, if the case has fluid.walls
 *
 * Point data of bodies: sheet_strength [m s-1] and, with force: pressure, the pressure jump [Pa], right side less left,
 * on the outline the value of the adjacent line. Cell data: fish (number, from 0), outline (1, or 0 for a line), speed
 * [m s-1], heading [degree]. Point data of wakes: circulation [m2 s-1] with decay, age [s], fish. */
#ifndef VTK_H
#define VTK_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/status.h"

/* Write all rows of the result file at from to the folder; create a missing folder. Without overwrite existing files
 * are refused. The list of times is written last; *list: the path. Fails with STATUS_FILE or STATUS_MEMORY. */
enum status vtk_export(struct arena *arena, const char *from, const char *folder, bool overwrite, const char **list);

#endif
