/* Included ahead of every file of the library, by the build: what the public header declares is visible
 * outside the shared library; all else is compiled as hidden. */
#ifndef TMI_EXPORTS_H
#define TMI_EXPORTS_H

#pragma GCC visibility push(default)
#include "tapemark.h"
#pragma GCC visibility pop

#endif
