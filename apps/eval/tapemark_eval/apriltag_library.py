"""AprilTag's own library, as Debian ships it (libapriltag3, 3.3.0), through its C interface."""

import ctypes

import numpy


class _Family(ctypes.Structure):
    _fields_ = [("ncodes", ctypes.c_uint32), ("codes", ctypes.c_void_p), ("width_at_border", ctypes.c_int),
                ("total_width", ctypes.c_int)]


class _Detector(ctypes.Structure):
    """What users may set; the rest of it follows."""

    _fields_ = [("nthreads", ctypes.c_int), ("quad_decimate", ctypes.c_float), ("quad_sigma", ctypes.c_float),
                ("refine_edges", ctypes.c_bool)]


class _Image(ctypes.Structure):
    _fields_ = [("width", ctypes.c_int32), ("height", ctypes.c_int32), ("stride", ctypes.c_int32),
                ("buf", ctypes.POINTER(ctypes.c_uint8))]


class _Array(ctypes.Structure):
    _fields_ = [("el_sz", ctypes.c_size_t), ("size", ctypes.c_int), ("alloc", ctypes.c_int),
                ("data", ctypes.POINTER(ctypes.c_void_p))]


class _Detection(ctypes.Structure):
    _fields_ = [("family", ctypes.c_void_p), ("id", ctypes.c_int)]


def _load():
    library = ctypes.CDLL("libapriltag.so.3")
    images = ctypes.CDLL("libapriltag-utils.so.3")
    library.tag36h11_create.restype = ctypes.POINTER(_Family)
    library.apriltag_detector_create.restype = ctypes.POINTER(_Detector)
    library.apriltag_detector_add_family_bits.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int]
    library.apriltag_detector_detect.restype = ctypes.POINTER(_Array)
    library.apriltag_detector_detect.argtypes = [ctypes.c_void_p, ctypes.POINTER(_Image)]
    library.tag36h11_destroy.argtypes = [ctypes.c_void_p]
    library.apriltag_detections_destroy.argtypes = [ctypes.c_void_p]
    library.apriltag_to_image.restype = ctypes.POINTER(_Image)
    library.apriltag_to_image.argtypes = [ctypes.c_void_p, ctypes.c_int]
    images.image_u8_destroy.argtypes = [ctypes.c_void_p]
    return library, images


class AprilTag36h11:
    """A detector for tag36h11. `decimate` is by how much frames are shrunk to find quadrilaterals in them: the
    library's default is 2, and 1 sees further at a higher price."""

    BITS_CORRECTED = 2  # the library's default

    def __init__(self, decimate):
        self._library, _ = _load()
        self._family = self._library.tag36h11_create()
        self._detector = self._library.apriltag_detector_create()
        self._library.apriltag_detector_add_family_bits(self._detector, self._family, self.BITS_CORRECTED)
        self._detector.contents.nthreads = 1
        self._detector.contents.quad_decimate = decimate

    def detect(self, gray):
        """The ids in a gray image."""
        height, width = gray.shape
        image = _Image(width, height, gray.strides[0], gray.ctypes.data_as(ctypes.POINTER(ctypes.c_uint8)))
        found = self._library.apriltag_detector_detect(self._detector, ctypes.byref(image))
        ids = [ctypes.cast(found.contents.data[i], ctypes.POINTER(_Detection)).contents.id
               for i in range(found.contents.size)]
        self._library.apriltag_detections_destroy(found)
        return ids


def picture(tag_id):
    """The black square of a tag36h11, a texel a module, as the library draws it; without its quiet zone."""
    library, images = _load()
    family = library.tag36h11_create()
    drawn = library.apriltag_to_image(family, tag_id)
    image = drawn.contents
    rows = numpy.ctypeslib.as_array(image.buf, shape=(image.height, image.stride))[:, :image.width].copy()
    images.image_u8_destroy(drawn)
    quiet = (family.contents.total_width - family.contents.width_at_border) // 2
    library.tag36h11_destroy(family)
    return rows[quiet:-quiet, quiet:-quiet]
