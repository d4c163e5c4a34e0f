/* The options that say what is seen: each takes the text behind it, or tells what would be right. */
#ifndef RENDER_THING_OPTIONS_H
#define RENDER_THING_OPTIONS_H

#include "render_options.h"

bool take_ids(render_options *all, const char *text, error_text *error);
bool take_picture(render_options *all, const char *text, error_text *error);
bool take_place(render_options *all, const char *text, error_text *error);
bool take_map(render_options *all, const char *text, error_text *error);
bool take_bars(render_options *all, const char *text, error_text *error);
bool take_cover(render_options *all, const char *text, error_text *error);
bool take_box(render_options *all, const char *text, error_text *error);
bool take_furnished(render_options *all, const char *text, error_text *error);
bool take_background(render_options *all, const char *text, error_text *error);
bool take_wall(render_options *all, const char *text, error_text *error);
bool take_floor(render_options *all, const char *text, error_text *error);

#endif
