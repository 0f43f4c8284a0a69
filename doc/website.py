#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The pages as a site:  doc/website.py [--build BUILD] [--pictures]

Writes build/site/index.html: all pages of the repository, the notebooks with what their cells give, references of the
Python module and of the public headers, a search and equations that need no net. Then looks at each link of the HTML.
Takes the packages of debian-packages-site.txt and a build with the Python module and liggghts-pfv. `--pictures` takes
some of its pages with Debian's chromium: doc/figures/site_*.png.
"""
import argparse
import os
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
FOLDER = ROOT / "doc/website"
sys.path[:0] = [str(ROOT / "doc"), str(FOLDER)]


def stop(message):
    print(f"website: {message}", file=sys.stderr)
    sys.exit(2)


def check_packages(others):
    listed = (ROOT / "debian-packages-site.txt").read_text().splitlines()
    wanted = [line for line in listed if line and not line.startswith("#")] + others
    state = subprocess.run(["dpkg-query", "-W", "-f", "${Package} ${db:Status-Status}\n", *wanted],
                           capture_output=True, text=True).stdout.splitlines()
    missing = [package for package in wanted if f"{package} installed" not in state]
    if missing:
        stop(f"packages are missing: apt-get install --no-install-recommends {' '.join(missing)}")


def version():
    line = next(line for line in (ROOT / "CMakeLists.txt").read_text().splitlines() if line.startswith("project(pfv"))
    return line.split()[2].rstrip(")")


def read_headers(work):
    """Doxygen's XML of the public headers, which breathe reads."""
    settings = {"PROJECT_NAME": "pfv", "INPUT": ROOT / "pfvlib/include/pfv", "OUTPUT_DIRECTORY": work,
                "EXTRACT_ALL": "YES", "GENERATE_XML": "YES", "GENERATE_HTML": "NO", "GENERATE_LATEX": "NO",
                "HAVE_DOT": "NO", "QUIET": "YES", "STRIP_FROM_PATH": ROOT / "pfvlib/include", "AUTOLINK_SUPPORT": "NO",
                "WARN_IF_UNDOCUMENTED": "NO", "WARN_IF_DOC_ERROR": "NO", "XML_PROGRAMLISTING": "NO"}
    words = "".join(f"{name} = {value}\n" for name, value in settings.items())
    subprocess.run(["doxygen", "-"], input=words, text=True, check=True)


def build(target, build_folder):
    from site_pages import stage
    work = target.with_name("site-work")
    for folder in (target, work):
        shutil.rmtree(folder, ignore_errors=True)
    work.mkdir(parents=True)
    read_headers(work)
    os.environ.update({name: str(value) for name, value in {
        "PYTHONPATH": build_folder / "python", "PFV_BIN": build_folder / "bin",
        "PFV_SITE_MODULE": build_folder / "python", "PFV_SITE_VERSION": version(),
        "PFV_SITE_STATIC": work / "static", "PFV_SITE_DOXYGEN": work / "xml",
        "PYDEVD_DISABLE_FILE_VALIDATION": 1}.items()})
    stage(work / "pages")
    shutil.copytree("/usr/share/javascript/katex", work / "static/katex",
                    ignore=shutil.ignore_patterns("contrib", "*.js", "*.mjs", "katex.css"))
    subprocess.run([sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html", "-c", FOLDER,
                    "-d", work / "doctrees", work / "pages", target], check=True)


def main():
    words = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    words.add_argument("--build", type=pathlib.Path, default=ROOT / "build", help="folder of the build (build)")
    words.add_argument("--pictures", action="store_true", help="take doc/figures/site_*.png with chromium")
    asked = words.parse_args()
    check_packages(["chromium"] if asked.pictures else [])
    if not list((asked.build / "python/pfv").glob("_pfv*.so")):
        stop(f"{asked.build}/python has no module pfv: build it first (./run.sh, or cmake --build)")
    target = ROOT / "build/site"
    build(target, asked.build.resolve())
    from site_links import faults_of
    faults = faults_of(target)
    for fault in faults:
        print(f"website: {fault}", file=sys.stderr)
    if faults:
        sys.exit(1)
    print(f"website: {target}/index.html")
    if asked.pictures:
        from site_pictures import take
        take(target, ROOT / "doc/figures")


if __name__ == "__main__":
    main()
