#!/usr/bin/python3
"""nan.py CHECKPOINT SECTION [TEXT]: end a section with a value that is not a number, or a text; the checksums fit."""

import struct
import sys
import zlib

whole = open(sys.argv[1], "rb").read()
out, at = bytearray(whole[:28]), 28
while at < len(whole):
    (n,) = struct.unpack("Q", whole[at + 24 : at + 32])
    section = bytearray(whole[at : at + 32 + n])
    if section[:24].split(b"\0")[0].decode() == sys.argv[2]:
        section[-8:] = sys.argv[3].encode() if sys.argv[3:] else struct.pack("d", float("nan"))
    out += section + struct.pack("I", zlib.crc32(section))
    at += 36 + n
open(sys.argv[1], "wb").write(out)
