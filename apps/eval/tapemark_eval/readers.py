"""The systems that are compared. Each reads gray images in this process, in one thread, with its defaults.

`reach_m`: experiments that stand further away are not asked of a system that reads next to nothing there even when
nothing else is wrong."""

import os
import time

os.environ.setdefault("OPENCV_FOR_THREADS_NUM", "1")  # also for the OpenCV that stag-python brings along

# pylint: disable=wrong-import-position
import cv2
import stag
import zxingcpp
from importlib import metadata

from .apriltag_library import AprilTag36h11
from .tapemark_library import Tapemark

cv2.setNumThreads(1)


ANY_DISTANCE = float("inf")


class Reading:
    """What a system found in a frame: ids (numbers, or None for a code that is no id), TMs (code, directed), time."""

    def __init__(self, ids, tms, cpu_ms):
        self.ids = ids
        self.tms = tms
        self.cpu_ms = cpu_ms


def _timed(work, *arguments):
    """What the call returns, and the processor time it took."""
    begin_ns = time.process_time_ns()
    answer = work(*arguments)
    return answer, (time.process_time_ns() - begin_ns) / 1e6


class TapemarkReader:
    name, label, marker = "tapemark", "Tapemark", "tape"
    reach_m = ANY_DISTANCE

    def __init__(self, library_path):
        self._decoder = Tapemark(library_path)

    def version(self):
        return f"{self._decoder.version()}, defaults, no map"

    def read(self, gray):
        image = self._decoder.prepare(gray.tobytes(), gray.shape[1], gray.shape[0])
        _, cpu_ms = _timed(self._decoder.decode, image)
        return Reading(self._decoder.cm_ids(), self._decoder.tms(), cpu_ms)


class ArucoReader:
    name, label, marker = "aruco", "ArUco", "aruco"
    reach_m = ANY_DISTANCE

    def __init__(self):
        dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_5X5_100)
        self._detector = cv2.aruco.ArucoDetector(dictionary)

    def version(self):
        return f"OpenCV {cv2.__version__}, DICT_5X5_100, defaults"

    def read(self, gray):
        (_, ids, _), cpu_ms = _timed(self._detector.detectMarkers, gray)
        return Reading([] if ids is None else [int(one) for one in ids.ravel()], [], cpu_ms)


def _qr_id(text):
    """The id in a QR code as marker_pictures.py or the marker's inventors write it; None for any other text."""
    digits = text.removeprefix("T")
    return int(digits) if digits.isascii() and digits.isdigit() else None


class QrOpencvReader:
    """The newer of OpenCV's two detectors: the older one reads next to nothing where several codes are in view."""

    name, label, marker = "qr-opencv", "QR code, OpenCV", "qr"
    reach_m = 1.6

    def __init__(self):
        self._detector = cv2.QRCodeDetectorAruco()

    def version(self):
        return f"OpenCV {cv2.__version__}, QRCodeDetectorAruco.detectAndDecodeMulti, defaults"

    def read(self, gray):
        (_, texts, _, _), cpu_ms = _timed(self._detector.detectAndDecodeMulti, gray)
        return Reading([_qr_id(text) for text in texts if text], [], cpu_ms)


class QrZxingReader:
    name, label, marker = "qr-zxing", "QR code, ZXing-C++", "qr"
    reach_m = 2.4

    def version(self):
        return f"zxing-cpp {metadata.version('zxing-cpp')}, QR codes alone, defaults"

    def read(self, gray):
        found, cpu_ms = _timed(lambda: zxingcpp.read_barcodes(gray, formats=zxingcpp.BarcodeFormat.QRCode))
        return Reading([_qr_id(one.text) for one in found], [], cpu_ms)


class StagReader:
    name, label, marker = "stag", "STag", "stag"
    reach_m = ANY_DISTANCE

    def version(self):
        return f"stag-python {metadata.version('stag-python')}, HD11, defaults"

    def read(self, gray):
        (_, ids, _), cpu_ms = _timed(stag.detectMarkers, gray, 11)
        return Reading([int(one) for one in ids.ravel()] if len(ids) else [], [], cpu_ms)


class AprilTagReader:
    marker = "apriltag"
    reach_m = ANY_DISTANCE

    def __init__(self, decimate):
        self._decimate = decimate
        self.name = f"apriltag-{decimate}"
        self.label = "AprilTag" if decimate == 1 else "AprilTag, halved"
        self._detector = AprilTag36h11(decimate)

    def version(self):
        return f"libapriltag 3.3.0, tag36h11, quad_decimate {self._decimate}, otherwise defaults"

    def read(self, gray):
        ids, cpu_ms = _timed(self._detector.detect, gray)
        return Reading(ids, [], cpu_ms)


MAKERS = {
    "tapemark": TapemarkReader,
    "aruco": lambda _: ArucoReader(),
    "qr-opencv": lambda _: QrOpencvReader(),
    "qr-zxing": lambda _: QrZxingReader(),
    "stag": lambda _: StagReader(),
    "apriltag-1": lambda _: AprilTagReader(1),
    "apriltag-2": lambda _: AprilTagReader(2),
}  # in the order in which they are shown


def reader_named(name, library_path):
    return MAKERS[name](library_path)


def all_readers(library_path):
    return [reader_named(name, library_path) for name in MAKERS]
