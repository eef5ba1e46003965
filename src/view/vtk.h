/* vtk.h: a run as files of VTK, which ParaView opens: a list of times that names two or three files for each row.
 * Tested by tests/app/test_export.sh, which reads them with VTK.
 *
 *     FOLDER/NAME.pvd              the times; open this one
 *     FOLDER/NAME-bodies-0000.vtp  each fish as a line of its bound vortices and as an outline
 *     FOLDER/NAME-wakes-0000.vtp   the free vortices, in rows that hold them
 *     FOLDER/NAME-walls-0000.vtp   the walls as lines, in all rows, where the case has fluid.walls
 *
 * Point data of bodies: sheet_strength [m s-1] and, with force: pressure, the pressure jump [Pa], left less right, on
 * the outline as on the line beside it. Cell data: fish (its number,
 * from 0), outline (1, or 0 for a line), speed [m s-1], heading [degree]. Point data of wakes: circulation [m2 s-1]
 * with its decay, age [s], fish. */
#ifndef VTK_H
#define VTK_H

#include <stdbool.h>

#include "base/status.h"

/* Write all rows of the result file at from to the folder, which is made if it is missing. Existing files are refused
 * unless they may be overwritten; the list of times is the last to be written. name: NULL, or set to the path of the
 * list, which the caller frees. Fails with STATUS_FILE or STATUS_MEMORY. */
enum status vtk_export(const char *from, const char *folder, bool overwrite, char **name);

#endif
