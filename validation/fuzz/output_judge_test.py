#!/usr/bin/env python3
"""The judge of outputs finds a fault of every kind, and none where there is none."""

import io
import pathlib
import tempfile
import unittest
import zipfile
import zlib

import output_judge


class Judge(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.place.name)
        (self.folder / "out").mkdir()
        self.write("stdout", "")
        self.write("stderr", "")

    def tearDown(self):
        self.place.cleanup()

    def write(self, name, text):
        (self.folder / name).write_bytes(text if isinstance(text, bytes) else text.encode("utf-8"))

    def expect(self, fragment, form="text", code=0):
        answer = output_judge.judge(self.folder, form, code)
        if fragment:
            self.assertIn(fragment, answer)
        else:
            self.assertEqual(answer, "")

    def expect_file(self, fragment, name, text, code=0):
        self.write("out/" + name, text)
        self.expect(fragment, code=code)
        (self.folder / "out" / name).unlink()

    def test_archives(self):
        whole = io.BytesIO()
        with zipfile.ZipFile(whole, "w") as archive:
            archive.writestr("data.npy", b"\x93NUMPY\1\0" + b"x" * 50)
        self.expect_file("", "m.npz", whole.getvalue())
        self.expect_file("no archive", "m.npz", whole.getvalue()[:-1])
        self.expect_file("no archive", "m.npz", whole.getvalue().replace(b"xxxx", b"xxyx", 1))
        with zipfile.ZipFile(whole, "a") as archive:
            archive.writestr("words.txt", "no array")
        self.expect_file("damaged, or none", "m.npz", whole.getvalue())

    def test_words(self):
        self.write("stdout", "a caf\u00e9 and its \u00b5\n")
        self.expect("")
        self.write("stdout", b"Latin-1: caf\xe9\n")
        self.expect("stdout: not UTF-8")
        self.write("stdout", "\x1b[31m")
        self.expect("stdout: control character 0x1b")

    def test_bad_input_is_told(self):
        self.expect("nothing is said", code=2)
        self.write("stderr", "exactff: a b (c); d\n")
        self.expect("", code=2)

    def test_plain(self):
        for text, fragment in (("0\n", ""), ("4.9e-324\n", ""), ("1.5\n", "outside"), ("nan\n", "outside"), ("x\n", "no number")):
            self.write("stdout", text)
            self.expect(fragment, form="plain")

    def test_images(self):
        def chunk(kind, body):
            return len(body).to_bytes(4, "big") + kind + body + zlib.crc32(kind + body).to_bytes(4, "big")
        size = (2).to_bytes(4, "big") + (1).to_bytes(4, "big") + bytes([8, 2, 0, 0, 0])
        png = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", size) + chunk(b"IDAT", zlib.compress(bytes(7)))
        self.expect_file("", "a.png", png + chunk(b"IEND", b""))
        self.expect_file("cut off", "a.png", png)
        self.expect_file("damaged", "a.png", png.replace(b"\x08\x02", b"\x08\x03") + chunk(b"IEND", b""))
        self.expect_file("not PNG", "a.png", b"x")
        self.expect_file("not OpenEXR", "a.exr", b"x")
        exr = b"\x76\x2f\x31\x01\x02\0\0\0channels\0chlist\0\x01\0\0\0\0screenWindowWidth\0float\0\x04\0\0\0\0\0\x80\x3f\0"
        self.expect_file("", "a.exr", exr + (len(exr) + 8).to_bytes(8, "little") + b"x")
        self.expect_file("without pixels", "a.exr", exr + (len(exr) + 8).to_bytes(8, "little"))
        npy = b"\x93NUMPY\x01\x00\x3a\x00{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }\n"
        self.expect_file("", "a.npy", npy + bytes(16))
        self.expect_file("another size", "a.npy", npy + bytes(15))
        self.expect_file("", "a\x1b[31m", npy + bytes(16))
        self.expect_file("another size", "a\x1b[31m", npy + bytes(15))

    def test_json(self):
        self.expect_file("", "a.json", '{"a": [1, 2e-300]}\n')
        self.expect_file("not JSON", "a.json", '{"a": 1,}')
        self.expect_file("NaN is not JSON", "a.json", '{"a": NaN}')
        self.expect_file("a key twice", "a.json", '{"a": 1, "a": 2}')
        self.expect_file("'a' is null", "a.json", '{"a": null}')
        self.expect_file("not UTF-8", "a.json", b'{"a": "\xe9"}')

    def test_xml(self):
        self.expect_file("", "a.svg", '<svg width="3"><text>inf</text></svg>')
        self.expect_file("not XML", "a.xml", "<a><b></a>")
        self.expect_file("control character", "a.xml", "<a>\x01</a>")
        self.expect_file("no number", "a.svg", '<svg><path d="M 0 nan"/></svg>')

    def test_html(self):
        self.expect_file("", "a.html", "<html><body><p>a &lt; b<br>c</p><script>1 < 2</script></body></html>")
        self.expect_file("closes nothing", "a.html", "<p><b>a</p></b>")
        self.expect_file("not closed", "a.html", "<p>a")
        self.expect_file("a bare <", "a.html", "<p>1 < 2</p>")

    def test_scenes(self):
        self.expect_file("", "a.obj", b"g caf\xe9\nv 0 1 2e-3\n")
        self.expect_file("no end", "a.off", "OFF\n1 0 0\n0 0 0")
        self.expect_file("a number that is none", "a.obj", "v 0 nan 0\n")
        self.expect_file("wrong length", "a.stl", b"written".ljust(80) + b"\1\0\0\0")
        head = "ply\nformat binary_little_endian 1.0\nelement vertex 1\nelement face 1\nproperty list uchar\nend_header\n"
        self.expect_file("", "a.ply", head.encode() + b"\0" * 24 + b"\3" + b"\0" * 12)
        self.expect_file("38 bytes of data instead of 37", "a.ply", head.encode() + b"\0" * 24 + b"\3" + b"\0" * 13)

    def test_csv(self):
        self.expect_file("", "a.csv", '# c\na,b_error\n1,"x ""y"""\n1,nan\n')
        self.expect_file("not UTF-8", "a.csv", b"a\ncaf\xe9\n")
        self.expect_file("a row of 3 fields", "a.csv", "a,b\n1,2,3\n")
        self.expect_file("column a has nan", "a.csv", "a,b\nnan,2\n")
        self.expect_file("no end", "a.csv", "a,b\n1,2")
        self.expect_file("not CSV", "a.csv", 'a,b\n"1"x,2\n')

    def test_arrays(self):
        vtk = '<VTKFile><DataArray format="binary">\n%s\n</DataArray></VTKFile>'
        self.expect_file("", "a.vtp", vtk % "AQAAAAAAAAAH")
        self.expect_file("wrong length", "a.vtu", vtk % "AgAAAAAAAAAH")
        self.expect_file("not base64", "a.vtp", vtk % "A")
        self.expect_file("not XML", "a.vtp", "<VTKFile>")
        head = b"\x93NUMPY\1\0%c\0{'descr': '<f8', 'shape': (1, 2), }"
        self.expect_file("", "a.npy", head % (len(head) - 11) + b"\0" * 16)
        self.expect_file("another size", "a.npy", head % (len(head) - 11) + b"\0" * 8)
        self.expect_file("no NumPy array", "a.npy", b"x" * 100)

    def test_leftovers(self):
        self.expect_file("half-written", "a.svg.whole", "")
        self.expect_file("half-written", ".folder.partial-12-0", "", code=130)
        self.expect_file("a journal left behind", "a.part", "")
        self.write("stderr", "exactff: interrupted\n")
        self.expect_file("", "a.part", "", code=130)


if __name__ == "__main__":
    unittest.main()
