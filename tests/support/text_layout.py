"""Whether the words of a picture can be read: on the page, and not over one another."""
from matplotlib.axes._base import _AxesBase
from matplotlib.text import Text


def shown(fig):
    """Text artists with something in them that are drawn, and their boxes [pixels]"""
    fig.canvas.draw()
    renderer = fig.canvas.get_renderer()
    spare = spare_labels(fig)
    for text in fig.findobj(Text):
        if text.get_visible() and text.get_text().strip() and id(text) not in spare:
            yield text, text.get_window_extent(renderer)


def spare_labels(fig) -> set:
    """Of ticks that are kept and not drawn: those outside of their axis' limits."""
    spare, drawn = set(), set()
    for axes in fig.findobj(_AxesBase):
        for axis in (axes.xaxis, axes.yaxis):
            for tick in (*axis.majorTicks, *axis.minorTicks):
                spare |= {id(tick.label1), id(tick.label2)}
            if axes.get_visible() and axis.get_visible():
                for tick in axis._update_ticks():
                    drawn |= {id(label) for label in (tick.label1, tick.label2)}
    return spare - drawn


def faults(fig, slack: float = 1.5) -> list:
    """What leaves the page, and which pairs of words overlap by more than `slack` pixels."""
    found = []
    boxes = list(shown(fig))
    width, height = fig.bbox.width, fig.bbox.height
    for text, box in boxes:
        if box.x0 < -slack or box.y0 < -slack or box.x1 > width + slack or box.y1 > height + slack:
            found.append(f"off the page: {text.get_text()!r}")
    for k, (text, box) in enumerate(boxes):
        for other, beside in boxes[:k]:
            across = min(box.x1, beside.x1) - max(box.x0, beside.x0)
            down = min(box.y1, beside.y1) - max(box.y0, beside.y0)
            if across > slack and down > slack:
                found.append(f"{text.get_text()!r} lies over {other.get_text()!r}")
    return found
