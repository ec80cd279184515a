#!/usr/bin/env bash
# scripts/site.sh [FOLDER]: makes a web site of README.md and the pages of docs and cases, by default in results/site.
# A browser opens its index.html; its search needs a server: python3 -m http.server -d results/site
set -euo pipefail
# shellcheck source=scripts/setup.sh
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

setup_packages mkdocs
site=$(realpath -m "${1:-$root/results/site}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/pages"
for name in "$root"/*; do # as in the tree, so that links from page to page and to sources hold
  case ${name##*/} in build* | results) ;; *) cp -rs "$name" "$work/pages/" ;; esac
done
rm "$work/pages/tests/studies/soak.md" # a part of docs/studies/stability.md, with its links
cat >"$work/mkdocs.yml" <<EOT
site_name: Clathra
site_dir: $site
docs_dir: pages
use_directory_urls: false # it is read without a server, too
theme: {name: readthedocs, highlightjs: false} # which another host would serve
plugins: [search]
nav:
  - README.md
  - Guide: [docs/building.md, docs/tutorial.md, docs/running.md, docs/cases_reference.md, docs/options.md, docs/cases.md, docs/giving_up.md, docs/limits.md, docs/faults.md]
  - Theory: [docs/equations.md, docs/laws.md]
  - Code: [docs/architecture.md, docs/extending.md, CONTRIBUTING.md, CHANGELOG.md]
  - Evidence: [docs/verification.md]
  - Studies: [docs/studies/README.md, docs/studies/slopes.md, docs/studies/biaxial.md, docs/studies/masuda.md, docs/studies/plasticity.md, docs/studies/tradeoff.md, docs/studies/stability.md, docs/studies/benchmark.md, docs/studies/scale.md, docs/studies/forecast.md, docs/studies/mutation.md, docs/studies/verification.md]
EOT
quietly "$work/log" mkdocs build --strict -f "$work/mkdocs.yml" || die "a page is wrong"
say "$site/index.html"
