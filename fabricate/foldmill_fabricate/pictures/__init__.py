"""Pictures for people: the pattern, the folded form, the sheet with both its faces.

Each is a pure function to the bytes of a PNG or SVG, the same bytes for the same input. matplotlib
is imported inside the functions, without pyplot, so that nobody's global state is touched.
"""

from foldmill_fabricate.pictures.angles import angles_picture
from foldmill_fabricate.pictures.as_cut import as_cut_picture
from foldmill_fabricate.pictures.as_cut_svg import as_cut_svg
from foldmill_fabricate.pictures.faults import faults_picture
from foldmill_fabricate.pictures.folded import folded_picture
from foldmill_fabricate.pictures.gallery import gallery
from foldmill_fabricate.pictures.motion import motion_picture
from foldmill_fabricate.pictures.pattern import pattern_picture
from foldmill_fabricate.pictures.pattern_svg import pattern_svg
from foldmill_fabricate.pictures.places import places_picture
from foldmill_fabricate.pictures.sheet import sheet_picture
from foldmill_fabricate.pictures.show import show_picture
from foldmill_fabricate.pictures.stages import stages_picture

__all__ = [
    "angles_picture",
    "as_cut_picture",
    "as_cut_svg",
    "faults_picture",
    "folded_picture",
    "gallery",
    "motion_picture",
    "pattern_picture",
    "pattern_svg",
    "places_picture",
    "sheet_picture",
    "show_picture",
    "stages_picture",
]
