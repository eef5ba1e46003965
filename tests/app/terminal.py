"""Run a command in a terminal of some columns, and print what the terminal got."""
import fcntl, os, pty, re, struct, sys, termios
child, terminal = pty.fork()
if child == 0:
    fcntl.ioctl(2, termios.TIOCSWINSZ, struct.pack("HHHH", 24, int(sys.argv[1]), 0, 0))
    os.execv(sys.argv[2], sys.argv[2:])
got = b""
while True:
    try:
        more = os.read(terminal, 4096)
    except OSError:
        break
    if not more:
        break
    got += more
os.waitpid(child, 0)
lines = got.decode().replace("\x1b[K", "").replace("\r\n", "\n")
progress = re.compile(r"t +[0-9.]+ s(?:  |$)|beat +[0-9]+|[0-9]+ of [0-9]+ members")
drawn = [part for line in lines.split("\n") for part in line.split("\r") if progress.match(part)]
assert drawn, lines  # a fast machine draws few
assert max(map(len, drawn)) < int(sys.argv[1]), drawn
assert max(map(len, drawn)) > int(sys.argv[1]) // 2, drawn
# the time and the percentage take 19 columns: all but the last
assert int(sys.argv[1]) != 20 or max(map(len, drawn)) == 19, drawn
# one line, redrawn: no line of progress ends with a line feed
assert not any(progress.match(line.split("\r")[-1]) for line in lines.split("\n")), lines
# the first line of a study comes at once; a slow program first counts the members that it has estimated and checked
done = [part for part in drawn if not re.search("members (estimated|checked)", part)]
assert "members" not in done[0] or re.fullmatch("0 of [0-9]+ members done    0 %  0 s left  0 failed  1 running", done[0]), drawn
