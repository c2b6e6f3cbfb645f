"""What tests in Python hold programs to."""


def check(holds, law):
    if not holds:
        raise AssertionError(law)
