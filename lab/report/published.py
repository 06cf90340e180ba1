"""Published figures, for comparison with measured ones.

Viktor Kämpe, Erik Sintorn, Ulf Assarsson, High Resolution Sparse Voxel DAGs, ACM Transactions on
Graphics 32(4), SIGGRAPH 2013. Table 1: seconds to reduce an SVO to a DAG, and the part of them
spent in sorting, on an Intel Core i7 3930K (six cores). Rows of Hairball and Lucy as corrected for
an interleaving in the print. Table 2: nodes and memory (2^20 bytes) of DAG, ESVO and SVO.

Samuli Laine, Tero Karras, Efficient Sparse Voxel Octrees, I3D 2010, Tables 1 and 2: megabytes and
seconds of builds on four cores of a Core2 Quad Q9300, and million primary rays per second on a
Quadro FX 5800.
"""

from text import NAN

# The SVDAG paper.
SVDAG_SOURCE = "Kämpe et al. 2013, Table 1 (Core i7-3930K of 2011, 6 cores)"
SVDAG_CORES = 6
TABLE2_SOURCE = "Kämpe et al. 2013, Table 2"
TABLE1_FIRST_LEVELS = 9  # the columns are 512³, 1024³, ... 8192³
TABLE2_FIRST_LEVELS = 11  # 2048³, 4096³, ... 65536³

# Seconds: all, of it sorting.
REDUCTIONS = {
    "Crysponza": ([.0084, .033, .3, 1.0, 4.5], [.0019, .0055, .05, .14, .6]),
    "EpicCitadel": ([.0015, .005, .05, .2, .8], [.0007, .0012, .006, .024, .1]),
    "SanMiguel": ([.0026, .0083, .06, .23, .95], [.0013, .0017, .008, .03, .14]),
    "Hairball": ([.043, .202, 2.19, 9.7, 40.6], [.0051, .029, .23, 1.0, 4.5]),
    "Lucy": ([.0026, .0084, .08, .31, 1.3], [.0007, .0016, .009, .04, .14]),
}

# Million nodes, megabytes.
SIZES = {
    "Crysponza": {"DAG": ([1, 1, 2, 4, 9, 23], [4, 11, 27, 71, 184, 476]),
                  "ESVO": ([5, 12, 32, 94, 226, 521], [38, 88, 243, 715, 1721, 3970]),
                  "SVO": ([12, 51, 205, 822, 3290, 13169], [12, 48, 195, 784, 3138, 12559])},
    "EpicCitadel": {"DAG": ([1, 1, 1, 3, 7, 18], [3, 7, 19, 53, 142, 371]),
                    "ESVO": ([1, 3, 7, 17, 38, 81], [7, 20, 53, 124, 287, 613]),
                    "SVO": ([2, 6, 21, 85, 340, 1364], [2, 5, 20, 81, 324, 1301])},
    "SanMiguel": {"DAG": ([1, 1, 2, 5, 13, 34], [3, 10, 31, 93, 270, 742]),
                  "ESVO": ([4, 14, 57, 229, 922, 3698], [26, 107, 433, 1747, 7030, 28212]),
                  "SVO": ([4, 14, 56, 224, 903, 3628], [4, 13, 53, 214, 861, 3460])},
    "Hairball": {"DAG": ([5, 15, 44, 115], [117, 339, 996, 2629]),
                 "ESVO": ([53, 224, 924, 3649], [401, 1709, 7049, 27837]),
                 "SVO": ([45, 188, 781, 3191], [43, 180, 745, 3044])},
    "Lucy": {"DAG": ([1, 1, 2, 6, 16, 46], [3, 10, 32, 110, 348, 983]),
             "ESVO": ([2, 8, 26, 76, 160, 255], [15, 56, 198, 576, 1219, 1941]),
             "SVO": ([2, 7, 27, 108, 430, 1720], [2, 7, 26, 103, 410, 1640])},
}

# At the highest resolution that the paper built: resolution, DAG, SVO.
BITS_PER_VOXEL = {"Crysponza": ("64K³", 0.08, 2.07), "EpicCitadel": ("64K³", 0.65, 2.29),
                  "SanMiguel": ("64K³", 0.45, 2.08), "Hairball": ("16K³", 2.24, 2.59),
                  "Lucy": ("64K³", 1.54, 2.57)}

FIGURE1 = {"scene": "EpicCitadel", "device": "GTX680", "levels": 17, "voxels": 19e9, "dag_megabytes": 945,
           "svo_megabytes": 5.1 * 1024, "shadow_rays_per_second": 240e6, "occlusion_rays_per_second": 170e6}

# The ESVO paper.
ESVO_SOURCE = ("Laine and Karras 2010, Tables 1 and 2 (builds: Core2 Quad Q9300, 4 cores; rays: Quadro FX "
               "5800)")
ESVO_CORES = 4
ESVO_FIRST_LEVELS = 10
ESVO_SIZES = [(512, 384), (1024, 768), (2048, 1536)]

# Megabytes and seconds from 10 levels on; bytes per voxel; for each of ESVO_SIZES million rays per
# second at triangles, cubes, contours, contours with beams.
ESVO_SCENES = {
    "City": {"megabytes": [13, 39, 131, 432, 1368], "seconds": [14, 23, 48, 115, 311], "bytes_per_voxel": 5.44,
             "mrays": [[46.7, 45.1, 79.9, 88.6], [68.5, 54.3, 89.1, 106.0], [77.1, 63.9, 97.4, 123.8]]},
    "Sibenik": {"megabytes": [41, 141, 440, 1034, 1857], "seconds": [10, 31, 90, 194, 336], "bytes_per_voxel": 5.68,
                "mrays": [[64.3, 38.7, 80.0, 82.5], [94.1, 46.5, 94.1, 103.6], [107.1, 55.1, 103.9, 122.0]]},
    "Sibenik-D": {"megabytes": [79, 314, 1192, 2806], "seconds": [70, 274, 1342, 2541], "bytes_per_voxel": 8.10,
                  "mrays": [[NAN, 24.8, 32.6, 37.5], [NAN, 30.2, 38.7, 48.3], [NAN, 37.1, 43.6, 60.9]]},
    "Hairball": {"megabytes": [442, 1552], "seconds": [294, 628], "bytes_per_voxel": 7.48,
                 "mrays": [[11.6, 22.4, 24.1, 24.1], [20.5, 22.5, 27.9, 28.4], [31.2, 29.2, 36.5, 38.2]]},
    "Fairy": {"megabytes": [11, 35, 99, 239, 376, 639, 1109], "seconds": [6, 15, 38, 86, 121, 178, 282],
              "bytes_per_voxel": 5.62,
              "mrays": [[63.9, 62.1, 128.2, 132.6], [125.1, 69.4, 145.4, 150.9], [155.8, 78.6, 160.4, 169.2]]},
    "Conference": {"megabytes": [17, 40, 96, 220, 512, 1328], "seconds": [7, 13, 24, 51, 115, 288],
                   "bytes_per_voxel": 5.16,
                   "mrays": [[69.1, 35.8, 97.9, 104.4], [111.9, 43.8, 110.3, 124.3], [134.0, 52.3, 120.2, 140.8]]},
}


def at_levels(values, levels, first_levels):
    """Returns the value for a grid of 2^levels of a row that begins at `first_levels`; NaN: not in the paper."""
    column = levels - first_levels
    return float(values[column]) if 0 <= column < len(values) else NAN


def reduction_at(scene, levels):
    """Returns the seconds of the reduction and of its sorting; NaN: not in the paper."""
    return tuple(at_levels(row, levels, TABLE1_FIRST_LEVELS) for row in REDUCTIONS.get(scene, ([], [])))


def esvo_scene(match):
    """Returns the figures of a matched scene, or None if none may stand beside measured ones."""
    return ESVO_SCENES[match.scene.name] if match is not None and match.has_figures else None


def esvo_levels_of_rates(scene):
    """Returns the levels of the octree whose rates Table 2 has: the largest that fitted into 4 GB."""
    return ESVO_FIRST_LEVELS - 1 + len(scene["megabytes"])


def esvo_mrays(scene, levels, size):
    """Returns the four rates for an octree of so many levels at a size; NaN: not in the paper."""
    if scene is not None and levels == esvo_levels_of_rates(scene) and tuple(size) in ESVO_SIZES:
        return scene["mrays"][ESVO_SIZES.index(tuple(size))]
    return [NAN] * 4


def esvo_voxels_per_core_second(scene, levels):
    """Returns NaN if the paper has no such octree. Assumes megabytes of 2^20 bytes, and for all
    octrees the bytes per voxel of the largest one."""
    if scene is None:
        return NAN
    megabytes, seconds = (at_levels(scene[key], levels, ESVO_FIRST_LEVELS) for key in ("megabytes", "seconds"))
    return megabytes * 2**20 / scene["bytes_per_voxel"] / (seconds * ESVO_CORES)
