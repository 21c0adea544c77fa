# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""Arrays in and out, with and without NumPy; they outlive what they came from."""

import array
import ctypes
import gc
import subprocess
import sys
import unittest

import excavplan as ex

try:
    import numpy
except ImportError:
    numpy = None

HEIGHTS = [[0.0, 1.0, 2.0], [3.0, 4.0, 5.0]]


class Arrays(unittest.TestCase):
    def test_lists_buffers_and_views_give_the_same_map(self):
        flat = array.array("d", [each for row in HEIGHTS for each in row])
        view = memoryview(flat).cast("B").cast("d", (2, 3))
        for source in (HEIGHTS, tuple(map(tuple, HEIGHTS)), view):
            self.assertEqual(ex.HeightMap(source).z.tolist(), HEIGHTS)

    def test_other_kinds_of_numbers(self):
        for code in "fdbBhHiIlLqQ":
            flat = memoryview(array.array(code, range(6))).cast("B").cast(code, (2, 3))
            self.assertEqual(ex.HeightMap(flat).z.tolist(), HEIGHTS, code)

    def test_numbers_in_the_other_order_of_bytes(self):
        for kind in (ctypes.c_double, ctypes.c_float, ctypes.c_int16, ctypes.c_uint32,
                     ctypes.c_int64):
            swapped = kind.__ctype_be__ if sys.byteorder == "little" else kind.__ctype_le__
            flat = (swapped * 3 * 2)()
            for row, numbers in enumerate(HEIGHTS):
                for col, each in enumerate(numbers):
                    flat[row][col] = kind(int(each)).value
            self.assertEqual(ex.HeightMap(flat).z.tolist(), HEIGHTS, kind)

    def test_an_array_outlives_its_owner_and_cannot_be_written(self):
        z = ex.HeightMap(HEIGHTS).z
        points = ex.Cloud([[1, 2, 3]]).points
        gc.collect()
        self.assertEqual(z.tolist(), HEIGHTS)
        self.assertEqual(points.tolist(), [[1.0, 2.0, 3.0]])
        with self.assertRaises((TypeError, ValueError)):
            z[0, 0] = 1.0

    def test_a_part_outlives_its_whole(self):
        extent = ex.HeightMap(HEIGHTS, origin=(1, 2), cell_size=0.5).extent
        limits = ex.load_machine("zx120").limits[0]
        gc.collect()
        self.assertEqual((extent.x_min, extent.y_min, extent.x_max, extent.y_max),
                         (1.0, 2.0, 2.5, 3.0))
        self.assertLess(limits.lower, limits.upper)

    def test_arrays_leak_nothing(self):
        import resource
        heights = ex.flat_ground(ex.Rectangle(0, 0, 20, 20), 0.05)  # 1.3 MB an array
        before = 0
        for turn in range(300):
            heights.z
            if turn == 50:
                before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        self.assertLess(after - before, 50_000)  # kB

    def test_without_numpy_arrays_are_memoryviews(self):
        program = ("import sys; sys.modules['numpy'] = None\n"
                   "import excavplan as ex\n"
                   f"z = ex.HeightMap({HEIGHTS}).z\n"
                   "assert type(z) is memoryview and z.shape == (2, 3) and z[1, 2] == 5.0\n"
                   f"assert z.readonly and ex.HeightMap(z).z.tolist() == {HEIGHTS}\n"
                   "assert len(ex.Cloud([]).points) == 0\n")
        subprocess.run([sys.executable, "-c", program], check=True)

    @unittest.skipUnless(numpy, "NumPy is not installed")
    def test_with_numpy_arrays_are_its_own(self):
        whole = numpy.arange(24, dtype=numpy.float32).reshape(4, 6)
        z = ex.HeightMap(whole[::2, ::-2]).z
        self.assertIsInstance(z, numpy.ndarray)
        self.assertEqual(z.tolist(), whole[::2, ::-2].tolist())
        self.assertEqual(ex.HeightMap(numpy.asfortranarray(whole)).z.tolist(), whole.tolist())

    @unittest.skipUnless(numpy, "NumPy is not installed")
    def test_a_row_that_is_broadcast_fills_no_memory(self):
        self.assertEqual(ex.HeightMap(numpy.broadcast_to(2.0, (4, 5))).z.sum(), 40.0)
        row = numpy.zeros(3)
        for rows in (10 ** 9, 10 ** 15):
            with self.assertRaisesRegex(ex.Error, "broadcast, expected at most 20000000 numbers"):
                ex.Cloud(numpy.broadcast_to(row, (rows, 3)))
        for order in "<>":
            whole = numpy.arange(24, dtype=order + "f8").reshape(4, 6)
            self.assertEqual(ex.HeightMap(whole).z.tolist(), whole.tolist())

    @unittest.skipUnless(numpy, "NumPy is not installed")
    def test_the_first_arrays_may_be_asked_for_by_several_threads(self):
        program = ("import sys, threading; import excavplan as ex\n"
                   "sys.setswitchinterval(1e-6)\n"
                   "heights = ex.HeightMap([[1.0]])\n"
                   "threads = [threading.Thread(target=lambda: heights.z) for _ in range(8)]\n"
                   "for thread in threads: thread.start()\n"
                   "for thread in threads: thread.join()\n"
                   "print(type(heights.z).__name__)")
        done = subprocess.run([sys.executable, "-c", program], check=True, timeout=60,
                              stdout=subprocess.PIPE, text=True)
        self.assertEqual(done.stdout, "ndarray\n")

    def test_the_import_is_fast_and_leaves_numpy_out(self):
        program = ("import time; start = time.perf_counter(); import excavplan, sys\n"
                   "assert 'numpy' not in sys.modules\n"
                   "print(time.perf_counter() - start)")
        times = [float(subprocess.run([sys.executable, "-c", program], check=True,
                                      stdout=subprocess.PIPE).stdout) for _ in range(5)]
        self.assertLess(min(times), 0.3)


if __name__ == "__main__":
    unittest.main()
