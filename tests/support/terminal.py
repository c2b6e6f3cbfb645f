"""A terminal of so many columns, for programs that draw on one: what stands on its screen, and when."""
import fcntl
import os
import pty
import select
import struct
import termios
import time


class Screen:
    """What a terminal shows of carriage returns, new lines and "clear to the end of the line", as xterm does it."""

    def __init__(self, columns):
        self.columns, self.lines, self.row, self.column = columns, [[]], 0, 0

    def feed(self, text):
        at = 0
        while at < len(text):
            if text.startswith("\x1b[K", at):
                del self.lines[self.row][self.column:]
                at += 3
                continue
            if text.startswith("\x1b[", at):  # bold, plain
                end = at + 2
                while not text[end].isalpha():
                    end += 1
                at = end + 1
                continue
            self.put(text[at])
            at += 1

    def put(self, sign):
        if sign == "\r":
            self.column = 0
        elif sign == "\n":
            self.down()
        else:
            if self.column == self.columns:
                self.down()
                self.column = 0
            line = self.lines[self.row]
            line.extend(" " * (self.column + 1 - len(line)))
            line[self.column] = sign
            self.column += 1

    def down(self):
        self.row += 1
        if self.row == len(self.lines):
            self.lines.append([])

    def text(self):
        return ["".join(line).rstrip() for line in self.lines]


def run(words, columns, interrupt_after=None, folder=None, patience=60.0):
    """Runs a program on a terminal of its own. Ctrl-C is typed after so many seconds.
    Returns its status, and the screens [(seconds, lines)] whenever it wrote."""
    child, terminal = pty.fork()
    if child == 0:
        if folder:
            os.chdir(folder)
        os.environ["TERM"] = "xterm"
        os.environ.pop("COLUMNS", None)
        time.sleep(0.05)  # until the terminal has its width
        os.execv(words[0], words)
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    begin, screen, seen, typed = time.monotonic(), Screen(columns), [], False
    pending = b""
    while True:
        now = time.monotonic() - begin
        if now > patience:
            os.kill(child, 9)
            raise SystemExit(f"{words}: not over after {patience} s")
        if interrupt_after is not None and not typed and now > interrupt_after:
            os.write(terminal, b"\x03")
            typed = True
        if not select.select([terminal], [], [], 0.05)[0]:
            continue
        try:
            data = os.read(terminal, 65536)
        except OSError:  # the program is gone
            break
        if not data:
            break
        pending += data
        try:
            text, pending = pending.decode(), b""
        except UnicodeDecodeError:  # in the middle of a sign
            continue
        screen.feed(text)
        seen.append((time.monotonic() - begin, screen.text()))
    os.close(terminal)
    status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    return status, seen
