"""The decoder itself, from the shared library, in this process: nothing but Python is needed."""

import ctypes

CM_CAPACITY, TM_CAPACITY = 128, 16
TM_MAX_CMS = 32
REJECT_COUNT = 9


class Image(ctypes.Structure):
    _fields_ = [("pixels", ctypes.c_char_p), ("width_px", ctypes.c_int32), ("height_px", ctypes.c_int32),
                ("stride_bytes", ctypes.c_ssize_t)]


class Point(ctypes.Structure):
    _fields_ = [("x_px", ctypes.c_float), ("y_px", ctypes.c_float)]


class Cm(ctypes.Structure):
    _fields_ = [("id", ctypes.c_int32), ("word", ctypes.c_uint8 * 10), ("corners", Point * 4),
                ("confidence", ctypes.c_float), ("doubtful_cells", ctypes.c_uint8),
                ("corrected_cells", ctypes.c_uint8), ("tm", ctypes.c_int16), ("slot", ctypes.c_int16)]


class Tm(ctypes.Structure):
    _fields_ = [("code", ctypes.c_char * (TM_MAX_CMS + 1)), ("length", ctypes.c_uint8), ("directed", ctypes.c_bool),
                ("vote", ctypes.c_float), ("confidence", ctypes.c_float), ("corners", Point * 4)]


class Stats(ctypes.Structure):
    _fields_ = [(name, ctypes.c_uint32) for name in (
        "limits", "work", "tiles", "tiles_active", "pattern_hits", "finders_tried", "finders", "segments",
        "cms_tried", "cms_read")] + [("rejects", ctypes.c_uint32 * REJECT_COUNT)]


class Result(ctypes.Structure):
    _fields_ = [("cms", ctypes.POINTER(Cm)), ("cm_capacity", ctypes.c_size_t), ("cm_count", ctypes.c_size_t),
                ("tms", ctypes.POINTER(Tm)), ("tm_capacity", ctypes.c_size_t), ("tm_count", ctypes.c_size_t),
                ("finders", ctypes.c_void_p), ("finder_capacity", ctypes.c_size_t), ("finder_count", ctypes.c_size_t),
                ("stats", Stats)]


class Tapemark:
    """A decoder with its workspace and its results."""

    def __init__(self, library_path):
        self._library = ctypes.CDLL(library_path)
        self._library.tapemark_version.restype = ctypes.c_char_p
        self._library.tapemark_status_text.restype = ctypes.c_char_p
        self._library.tapemark_workspace_bytes.restype = ctypes.c_size_t
        self._library.tapemark_decode.argtypes = [
            ctypes.POINTER(Image), ctypes.c_void_p, ctypes.c_void_p, ctypes.c_size_t, ctypes.POINTER(Result)]
        self._cms = (Cm * CM_CAPACITY)()
        self._tms = (Tm * TM_CAPACITY)()
        self._result = Result(cms=self._cms, cm_capacity=CM_CAPACITY, tms=self._tms, tm_capacity=TM_CAPACITY)
        self._workspace = b""
        self._size = None

    def version(self):
        return self._library.tapemark_version().decode()

    def workspace_bytes(self):
        """Of the size of image that was decoded last."""
        return len(self._workspace)

    def prepare(self, pixels, width_px, height_px):
        """An image for decode(): what it needs is allocated here."""
        if self._size != (width_px, height_px):
            self._size = (width_px, height_px)
            self._workspace = ctypes.create_string_buffer(self._library.tapemark_workspace_bytes(width_px, height_px))
        return Image(pixels, width_px, height_px, width_px)

    def decode(self, image):
        status = self._library.tapemark_decode(ctypes.byref(image), None, self._workspace, len(self._workspace),
                                               ctypes.byref(self._result))
        if status < 0:
            raise RuntimeError(f"tapemark_decode: {self._library.tapemark_status_text(status).decode()}")

    def cm_ids(self):
        return [self._cms[i].id for i in range(self._result.cm_count)]

    def tms(self):
        """Code and whether its direction is known, for each TM."""
        return [(self._tms[i].code.decode(), self._tms[i].directed) for i in range(self._result.tm_count)]

    def grid(self, cm_ids):
        """A segment with bars as rows of modules, 1 is dark, without the quiet zone."""
        self._library.tapemark_segment_width_modules.restype = ctypes.c_size_t
        width = self._library.tapemark_segment_width_modules(ctypes.c_size_t(len(cm_ids)), ctypes.c_bool(True))
        modules = (ctypes.c_uint8 * (7 * width))()
        status = self._library.tapemark_segment_draw(
            (ctypes.c_int32 * len(cm_ids))(*cm_ids), ctypes.c_size_t(len(cm_ids)), ctypes.c_bool(True), modules,
            ctypes.c_size_t(len(modules)))
        if status != 0:
            raise ValueError(self._library.tapemark_status_text(status).decode())
        return [list(modules[row * width:(row + 1) * width]) for row in range(7)]
