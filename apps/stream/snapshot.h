/* Saves single frames, in a thread of its own: no frame waits for a slow disk. */
#ifndef STREAM_SNAPSHOT_H
#define STREAM_SNAPSHOT_H

#include "gray.h"

typedef struct snapshots snapshots;

/* NULL when memory runs out. */
snapshots *snapshots_open(void);

/* Begins to save a copy of the picture as frame-SECONDS.MILLISECONDS.pgm in the directory. What goes wrong is told
 * and counted, also that the one before is still being written. */
void snapshots_save(snapshots *self, const char *directory, const gray_view *view);

unsigned snapshots_failures(snapshots *self);

/* Waits for the one that is being written, for a second at most. NULL is fine. */
void snapshots_close(snapshots *self);

#endif
