"""The module figures, with the program of this test."""
import os, re, sys
root, program = sys.argv[1:3]
sys.path.insert(0, os.path.join(root, "scripts"))
import figures
figures.PROGRAM = program
