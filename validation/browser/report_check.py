#!/usr/bin/env python3
"""Opens a report in headless Chromium and checks that a reader gets to see it.

Usage: report_check.py REPORT.html [--tallest PIXELS] [--chromium FILE] [--chromedriver FILE]

Every chapter opens with a verdict; every figure has drawn; nothing is fetched; the page reads on a phone and on a screen, light and dark, and in print; its
references resolve. Needs Debian's chromium, chromium-driver and python3-selenium; no network. Exit code 0: all is well; 1: complaints, one a line; 2: the check could not be made.
"""

import argparse
import contextlib
import json
import os
import pathlib
import shutil
import signal
import sys
import tempfile

from selenium import webdriver
from selenium.common.exceptions import WebDriverException
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

PHONE, SCREEN, PAPER = 400, 1280, 718  # widths in CSS pixels; the last is A4 without its margins
LEAST_RUNNING_TEXT = 14  # pixels
LEAST_LETTERING = 8  # pixels, in figures on a phone
BODY_CONTRAST, OTHER_CONTRAST, FIGURE_CONTRAST = 7, 4.5, 3  # WCAG 2.2: text at AAA, at AA, and graphics
MARK_CONTRAST = 2  # Okabe and Ito's light colours have 2.2 on white

IN_PAGE = pathlib.Path(__file__).with_name("in_page.js").read_text(encoding="utf-8")


def chromium_options(chromium, profile):
    options = Options()
    options.binary_location = chromium
    options.set_capability("goog:loggingPrefs", {"performance": "ALL", "browser": "ALL"})
    for argument in (
        "--headless=new", f"--user-data-dir={profile}",
        "--no-sandbox", "--disable-dev-shm-usage", "--disable-gpu",  # as root, in a container
        "--host-resolver-rules=MAP * ~NOTFOUND",  # requests to the network are reported and blocked
        "--disable-background-networking", "--disable-component-update", "--disable-sync", "--no-first-run",
        "--hide-scrollbars", "--force-color-profile=srgb", "--lang=en", "about:blank",
    ):
        options.add_argument(argument)
    return options


@contextlib.contextmanager
def browser(chromium, chromedriver):
    """Chromium with a home of its own, which goes when it goes."""
    with tempfile.TemporaryDirectory(prefix="report-check-", ignore_cleanup_errors=True) as home:
        places = dict.fromkeys(("HOME", "TMPDIR", "XDG_CONFIG_HOME", "XDG_CACHE_HOME"), home)
        service = Service(executable_path=chromedriver, env=os.environ | places)
        driver = webdriver.Chrome(service=service, options=chromium_options(chromium, os.path.join(home, "profile")))
        try:
            driver.set_page_load_timeout(60)
            driver.set_script_timeout(60)
            yield driver
        finally:
            driver.quit()


class Reader:
    """A page in the browser, and what is wrong with it."""

    def __init__(self, driver, page):
        self.driver, self.page, self.complaints = driver, page.resolve(), []
        self.view(PHONE)
        driver.get("about:blank")
        self.log()  # remove the files of earlier pages
        driver.get(self.page.as_uri())

    def view(self, width, scheme="light", medium="screen"):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": 800, "deviceScaleFactor": 1, "mobile": width == PHONE})
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {
            "media": medium, "features": [{"name": "prefers-color-scheme", "value": scheme}]})
        self.condition = medium if medium == "print" else f"{width} px, {scheme}"

    def check(self, name, *arguments, anywhere=False):
        """One function of in_page.js; `anywhere`: what it finds does not depend on the view."""
        found = self.driver.execute_script(f"{IN_PAGE}\nreturn report_check.{name}(...arguments)", *arguments)
        self.complaints += [text if anywhere else f"{text} ({self.condition})" for text in found]

    def unfold(self):
        """Opens what is folded: it is checked as well."""
        self.driver.execute_script("document.querySelectorAll('details').forEach((fold) => { fold.open = true; })")

    def log(self):
        return [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]

    def check_requests(self):
        """The page itself, and pictures that are written in it, are all that may be asked for."""
        for message in self.log():
            if message["method"] != "Network.requestWillBeSent":
                continue
            url = message["params"]["request"]["url"]
            if url.split("#")[0] != self.page.as_uri() and not url.startswith(("data:", "blob:", "chrome:")):
                self.complaints.append(f"the page fetches {url}")
        for entry in self.driver.get_log("browser"):
            if entry["level"] == "SEVERE" and "favicon.ico" not in entry["message"]:
                self.complaints.append(f"the browser reports: {entry['message']}")

    def check_neighbours(self):
        """Links to files beside the page lead to files that are there."""
        links = self.driver.execute_script("return [...document.querySelectorAll('a[href]')].map((a) => a.protocol === "
                                           "'file:' ? decodeURIComponent(a.pathname) : '')")
        missing = {link for link in links if link and not os.path.exists(link)}
        names = sorted(pathlib.Path(link).name for link in missing)
        self.complaints += [f"a link leads to {name}, which is not there" for name in names]


def check_layout(reader, width, scheme, medium="screen"):
    reader.view(width, scheme, medium)
    reader.check("fits", width)
    reader.check("figures_are_drawn")
    reader.check("figures_stand_apart")
    reader.check("contrast_is_enough", BODY_CONTRAST, OTHER_CONTRAST, FIGURE_CONTRAST)
    reader.check("marks_are_told_from_paper", MARK_CONTRAST)


def check_folded(reader, tallest):
    """The page as it opens, before a reader unfolds anything; printed, it is unfolded."""
    reader.check("chapters_open_with_a_verdict", anywhere=True)
    reader.view(SCREEN)
    if tallest:
        reader.check("is_no_taller", tallest)
    for width in (SCREEN, PHONE):
        reader.view(width)
        reader.check("no_column_is_cut")
    reader.view(PAPER, medium="print")
    reader.check("everything_is_unfolded")


def check_report(driver, page, tallest=None, enough=lambda complaints: False):
    """All complaints about the page, each once. `tallest`: its height on a screen as it opens, in pixels.

    `enough`: asked between the steps; the check ends early where it returns true.
    """
    reader = Reader(driver, page)
    for _ in steps(reader, tallest):
        if enough(reader.complaints):
            break
    return list(dict.fromkeys(reader.complaints))


def steps(reader, tallest):
    """The check, which pauses after each step."""
    reader.check_requests()
    yield
    check_folded(reader, tallest)
    yield
    reader.unfold()
    reader.check("page_is_described", anywhere=True)
    reader.check("ids_are_unique", anywhere=True)
    reader.check("references_resolve", anywhere=True)
    reader.check("nothing_lies_outside", anywhere=True)
    reader.check("figures_have_names", anywhere=True)
    reader.check_neighbours()
    yield
    for width, scheme in ((PHONE, "light"), (PHONE, "dark"), (SCREEN, "dark"), (SCREEN, "light")):
        check_layout(reader, width, scheme)
        yield
        if width == PHONE:
            reader.check("running_text_is_large", LEAST_RUNNING_TEXT)
            reader.check("lettering_can_be_read", LEAST_LETTERING)
            reader.check("no_column_is_cut")
            reader.check("no_mark_covers_a_label")
            yield
    for scheme in ("light", "dark"):  # of the reader's system; paper is white
        check_layout(reader, PAPER, scheme, "print")
        yield
    reader.check_requests()
    yield


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("report", type=pathlib.Path, metavar="REPORT.html")
    parser.add_argument("--tallest", type=int, metavar="PIXELS", help="height of the page on a screen, as it opens")
    add_browser_arguments(parser)
    return parser.parse_args()


def add_browser_arguments(parser):
    parser.add_argument("--chromium", default=shutil.which("chromium"), metavar="FILE")
    parser.add_argument("--chromedriver", default=shutil.which("chromedriver"), metavar="FILE")


def main():
    arguments = parse_arguments()
    if not arguments.report.is_file():
        sys.exit(f"{arguments.report}: no such file")
    with browser(arguments.chromium, arguments.chromedriver) as driver:
        complaints = check_report(driver, arguments.report, arguments.tallest)
    for complaint in complaints:
        print(f"{arguments.report.name}: {complaint}")
    print(f"{arguments.report}: " + (f"{len(complaints)} complaints" if complaints else "reads well"))
    return 1 if complaints else 0


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(2))  # so that the browser ends as well
    try:
        sys.exit(main())
    except WebDriverException as error:
        print(f"the browser failed: {error.msg}", file=sys.stderr)
        sys.exit(2)
