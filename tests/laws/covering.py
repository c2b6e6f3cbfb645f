"""Rows of levels in which every two levels of any two factors meet at least once (pairwise covering)."""
import random


def rows(factors, seed, tries=12):
    """Yields rows {factor: level}, each of which covers as many new pairs as the best of a few random ones.

    Greedy: about as many rows as twice the product of the two longest lists of levels. It never ends: where all pairs
    are covered it begins anew.
    """
    names = list(factors)
    draw = random.Random(seed)
    while True:
        # A dictionary, since a set's order is another in every process.
        open_pairs = dict.fromkeys((a, i, b, j) for n, a in enumerate(names) for b in names[n + 1:]
                                   for i in range(len(factors[a])) for j in range(len(factors[b])))
        while open_pairs:
            best, gain = None, -1
            for _ in range(tries):
                row = _row(names, factors, open_pairs, draw)
                new = sum((a, row[a], b, row[b]) in open_pairs for n, a in enumerate(names) for b in names[n + 1:])
                if new > gain:
                    best, gain = row, new
            for n, a in enumerate(names):
                for b in names[n + 1:]:
                    open_pairs.pop((a, best[a], b, best[b]), None)
            yield {name: factors[name][level] for name, level in best.items()}
            if gain < len(names) // 4:  # what is left are a few pairs: a row each is not worth it
                break


def _row(names, factors, open_pairs, draw):
    a, i, b, j = draw.choice(tuple(open_pairs)) if len(open_pairs) < 64 else next(iter(open_pairs))
    row = {a: i, b: j}
    for name in draw.sample(names, len(names)):
        if name not in row:
            row[name] = draw.randrange(len(factors[name]))
    return row
