"""The scenario of plain_sea.h, for tests in Python."""
from pathlib import Path

SEA = Path(__file__).with_name("plain_sea.h").read_text().split('R"(')[1].split(')"')[0]
