"""The sixty problems, from a checkout of the repository that collects them."""

from __future__ import annotations

import subprocess
from dataclasses import dataclass
from pathlib import Path

REPOSITORY = "https://github.com/aibasel/pyperplan"
COMMIT = "586b99f060bfe457f359aa8b4bae1a299fa4e8c7"
"""Of 16 June 2026. The repository is also the peer; nothing of it is kept here."""

NUMBERS = {
    "blocks": (5, 12, 18, 24, 30, 35),
    "gripper": (1, 5, 10, 15, 20),
    "logistics": (5, 12, 18, 22, 25, 28),
    "depot": (1, 2, 4, 7, 10, 13, 16, 19),
    "satellite": (1, 4, 7, 10, 13, 16, 20),
    "rovers": (5, 10, 15, 20, 25),
    "zenotravel": (5, 9, 12, 15, 18),
    "miconic": (10, 20, 30),
    "freecell": (1, 4, 8, 12),
    "sokoban": (1, 5, 10),
    "tpp": (6, 10, 15, 20),
    "transport": (1, 4, 8, 12),
}
"""Domains, with the numbers of the problems as the repository counts them."""


@dataclass(frozen=True, slots=True)
class Instance:
    """A problem with its domain, as files."""

    name: str
    domain: Path
    problem: Path


def instances(checkout: Path, wanted: list[str]) -> list[Instance]:
    """Give the problems.

    Args:
        checkout: The repository's folder.
        wanted: Domains, or problems such as `blocks-05`; all if empty.
    """
    folder = checkout / "benchmarks"
    found = []
    for domain, numbers in NUMBERS.items():
        for number in numbers:
            name = f"{domain}-{number:02d}"
            if not wanted or name in wanted or domain in wanted:
                problem = folder / domain / f"task{number:02d}.pddl"
                found.append(Instance(name, folder / domain / "domain.pddl", problem))
    missing = [each.problem for each in found if not each.problem.exists()]
    if missing:
        raise SystemExit(f"{missing[0]} is not there: name a checkout of {REPOSITORY}")
    return found


def checked_out(folder: Path) -> Path:
    """Give the repository at the pinned commit, fetched into a folder unless it lies there."""
    if (folder / "benchmarks").is_dir():
        return folder
    folder.mkdir(parents=True, exist_ok=True)
    try:
        for command in (
            ["init", "--quiet"],
            ["fetch", "--quiet", "--depth", "1", REPOSITORY, COMMIT],
            ["checkout", "--quiet", "FETCH_HEAD"],
        ):
            git = ["git", "-C", str(folder), *command]
            subprocess.run(git, check=True)  # noqa: S603 - the commands above
    except (OSError, subprocess.CalledProcessError) as error:
        raise SystemExit(
            f"{REPOSITORY} cannot be fetched ({error}). Clone it where there is a network, and "
            f"name the folder with --instances; the commit is {COMMIT[:7]}."
        ) from None
    return folder
