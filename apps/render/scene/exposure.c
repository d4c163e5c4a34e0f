#include "exposure.h"

#include "pose_paint.h"
#include "prints.h"

bool paint_exposure(const scene *view, canvas *picture)
{
    prints all;
    bool done = prints_create(&all, view) && paint_pose(view, &all, picture);
    prints_release(&all);
    return done;
}
