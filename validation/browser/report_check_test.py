#!/usr/bin/env python3
"""Tests report_check.py: a page in order passes, and each fault put into it is found for what it is.

Usage: report_check_test.py [--chromium FILE] [--chromedriver FILE]. Exit code 0: all found; 1: not so.
"""

import argparse
import pathlib
import sys
import tempfile

import report_check

SOUND = pathlib.Path(__file__).with_name("sound.html")
SOUND_HEIGHT = 1200  # pixels on a screen: its two figures stand below each other
CURVE = '<path id="line" d="M60 240 L200 90 L370 60" stroke="#0072b2" stroke-width="2" fill="none"/>'
DATA = '<path class="data" d="M60 240 L370 60" stroke-width="2"/>'

# Each row: a text, its replacement, and words of the complaint that must follow.
FAULTS = {
    "a figure with axes alone": (CURVE, "", "figure 'Curve' (#curve) shows axes at most: nothing is drawn"),
    "a plot with its key alone": (DATA, "", "figure 'Plot' (#plot) shows axes at most: nothing is drawn"),
    "marks at no place": (CURVE, CURVE.replace("200", "nan"),
                          "figure 'Curve' (#curve) has a <path> at no finite place"),
    "marks beside the paper": (DATA, DATA + '<path d="M900 20 L980 90"/>',
                               "figure 'Plot' (#plot) has marks outside its paper"),
    "marks that nobody can see": (DATA, DATA.replace("/>", ' opacity="0"/>'), "'Plot' (#plot) shows axes at most"),
    "a plot like the paper": ('stroke="#d55e00"', 'style="stroke: color-mix(in srgb, var(--paper) 85%, #808080)"',
                              "figure 'Plot' (#plot) draws 'RMS' with a contrast of 1.2:1 (400 px, dark)"),
    "an empty figure": ("<figcaption>Error", "</figure><figure><h3>Void</h3><figcaption>Error",
                        "figure 'Void' holds neither svg nor img"),
    "a figure of no height": ('<svg viewBox="0 0 400 300" role="img" aria-label="Curve">',
                              '<svg viewBox="0 0 400 300" role="img" aria-label="Curve" style="height: 0">',
                              "is drawn 368 by 0 pixels large"),
    "a picture that is none": ("<table>", '<figure id="photo"><h3>Photo</h3><img src="data:image/png;base64,AAAA" '
                               'alt="A photo"></figure><table>', "(#photo) holds a picture that did not load"),
    "a figure without words": (' aria-label="Curve"', "", "'Curve' (#curve) has no name for those who cannot see it"),
    "small lettering": ('font-size="15"><text x="180"', 'font-size="7"><text x="180"', "has lettering of"),
    "lettering over lettering": ('<text x="60" y="270">1', '<text x="190" y="288">1', "run into one another"),
    "a picture from elsewhere": ("<h1", '<img src="https://example.org/a.png" alt="x"><h1',
                                 "the page fetches https://example.org/a.png"),
    "a style from elsewhere": (":root {", '@import "https://example.org/a.css"; :root {',
                               "refers to something else: @import"),
    "a script that fetches": ("<h1", "<script>fetch('https://example.org/c.json').catch(() => 0)</script><h1",
                              "the page fetches https://example.org/c.json"),
    "a script that fails": ("<h1", "<script>nowhere()</script><h1", "nowhere is not defined"),
    "overflow on a phone": ("<h1", '<div style="width: 600px">Broad</div><h1', "<div> 'Broad' reaches to"),
    "a table without its box": ('<div class="wide"><table>', "<div><table style='white-space: nowrap'>",
                                "<td> 'A table that wraps"),
    "a cut column": ("<table>", '<table style="white-space: nowrap">', "the table 'A table that wraps on a phone"),
    "a chapter without a verdict": ('<p class="verdict">', "<p>", "the chapter 'Verdict' does not open with a verdict"),
    "figures before the verdict": ("<h2>Verdict</h2>", "<h2>Verdict</h2><p>Some numbers first.</p>",
                                   "the chapter 'Verdict' does not open with a verdict"),
    "a verdict of two sentences": ("when it rains.", "when it rains. It is dry.", "opens with 2 sentences"),
    "a page that never ends": ("<h1", '<div style="height: 900px"></div><h1', f"px tall, over {SOUND_HEIGHT}"),
    "a fold that print keeps": ("details::details-content", "details.none::details-content",
                                "the part 'More' is folded (print)"),
    "a mark over a label": (DATA, DATA + '<circle cx="235" cy="20" r="4"/>', "draws a mark over 'RMS'"),
    "no viewport": ('<meta name="viewport" content="width=device-width, initial-scale=1">', "", "it names no viewport"),
    "overlapping figures": ("<style>", "<style>#plot { margin-top: -12rem }",
                            "'Curve' (#curve) and figure 'Plot' (#plot)"),
    "small print": ("font: 16px sans-serif", "font: 12px sans-serif", "running text is 12 px large"),
    "pale text": ("--ink: #222", "--ink: #777", "running text has a contrast of"),
    "pale captions": ("--soft: #555", "--soft: #999", "has a contrast of 2.8:1"),
    "an id twice": ('<figure id="plot">', '<figure id="curve">', "the id 'curve' is given 2 times"),
    "a reference to nothing": ('href="#curve"', 'href="#curves"', "nothing on the page is called '#curves'"),
    "a link to no file": ('href="#curve"', 'href="values.csv"', "a link leads to values.csv, which is not there"),
    "no language": (' lang="en"', "", "the page does not say its language"),
}


def check_text(driver, folder, text, **options):
    page = folder / "page.html"
    page.write_text(text, encoding="utf-8")
    return report_check.check_report(driver, page, tallest=SOUND_HEIGHT, **options)


def failure(driver, folder, fault):
    """Why the fault counts as not found, or None."""
    old, new, expected = FAULTS[fault]
    sound = SOUND.read_text(encoding="utf-8")
    assert sound.count(old) >= 1, f"{fault}: {old} is not in {SOUND}"
    is_found = lambda complaints: any(expected in text for text in complaints)
    complaints = check_text(driver, folder, sound.replace(old, new, 1), enough=is_found)
    if not complaints:
        return "nothing was found"
    return None if is_found(complaints) else f"it was taken for something else: {complaints[0]}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    report_check.add_browser_arguments(parser)
    arguments = parser.parse_args()
    failures = []
    with (report_check.browser(arguments.chromium, arguments.chromedriver) as driver,
          tempfile.TemporaryDirectory() as name):
        folder = pathlib.Path(name)
        complaints = check_text(driver, folder, SOUND.read_text(encoding="utf-8"))
        failures += [f"the sound page: {text}" for text in complaints]
        for fault in FAULTS:
            if reason := failure(driver, folder, fault):
                failures.append(f"{fault}: {reason}")
    print(*(f"FAILED {text}" for text in failures), f"{len(FAULTS)} faults, {len(failures)} failures", sep="\n")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
