# breathe wants one error a \throws: "\throws InputError, RunError" is two of them.
s/(\\throws [A-Za-z]+), (RunError|Stopped)/\1 \\throws \2/
s/(\\throws RunError), (Stopped)/\1 \\throws \2/
s/(\\throws [^\\]*[^, \\])[,;] (RunError|Stopped)/\1 \\throws \2/
