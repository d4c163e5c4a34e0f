#include "tapemark.h"

#define TEXT_OF(number) #number
#define TEXT(macro) TEXT_OF(macro)

const char *tapemark_version(void)
{
    return TEXT(TAPEMARK_VERSION_MAJOR) "." TEXT(TAPEMARK_VERSION_MINOR) "." TEXT(TAPEMARK_VERSION_PATCH);
}

const char *tapemark_status_text(tapemark_status status)
{
    switch (status) {
    case TAPEMARK_OK: return "done";
    case TAPEMARK_NOTHING_FOUND: return "nothing found";
    case TAPEMARK_NO_ROOM: return "more results than the caller's arrays hold";
    case TAPEMARK_UNFINISHED: return "nothing found before a limit was hit";
    case TAPEMARK_AMBIGUOUS: return "more than one place on the map fits";
    case TAPEMARK_BAD_CALL: return "bad call: an argument is NULL or out of its range";
    case TAPEMARK_BAD_CONFIG: return "bad configuration: a field is out of its range";
    case TAPEMARK_BAD_WORKSPACE: return "the workspace is NULL or too small";
    case TAPEMARK_BAD_MAP: return "bad map: an entry is out of order or out of its range";
    }
    return "unknown status";
}
