/* What can only be said, and chosen, when all options are known. */
#ifndef RENDER_CHOICES_H
#define RENDER_CHOICES_H

#include "render_options.h"

/* Output, format and kind of scene; defaults. False when options contradict each other. */
bool render_choose(render_options *all, int operand_count, char *operands[], error_text *error);

#endif
