"""Runs the programs and stores their measurements, with the day, the commit, the processor and its load by other
programs."""
import dataclasses
import datetime
import hashlib
import json
import os
import pathlib
import resource
import subprocess
import time


class Failed(Exception):
    """Says that a command did not yield a measurement."""


@dataclasses.dataclass
class Measurement:
    command: list[str]
    date: str
    commit: str      # last commit that changed the programs; with a + if there are uncommitted changes
    processor: str
    others: float    # fraction of the processors' time that other programs took meanwhile
    seconds: float
    data: dict       # the JSON that the program wrote with --stats
    output: str      # the file or folder of its -o, relative to the repository


def busy_seconds():
    """Returns the seconds that all processors have worked so far, for all programs together."""
    with open("/proc/stat", encoding="ascii") as file:
        user, nice, system, _idle, _wait, *interrupts = map(int, file.readline().split()[1:9])
    return (user + nice + system + sum(interrupts)) / os.sysconf("SC_CLK_TCK")


def own_seconds():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def processor():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        models = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
    return f"{' '.join(models[0].split())}, {len(models)} cores"


def last_commit(source):
    """Returns the last commit that changed the programs or the models, with a + if there are uncommitted changes."""
    paths = ["--", "*.cpp", "*.h", "models"]
    git = lambda *words: subprocess.run(["git", *words, *paths], cwd=source, capture_output=True, text=True,
                                        check=True).stdout.strip()
    return git("log", "-1", "--format=%h") + ("+" if git("status", "--porcelain") else "")


class Runner:
    """Measures each command once and stores the result below out/figures. With `kept`, results that exist there are
    used."""

    def __init__(self, programs, source, kept, commit):
        self.programs, self.source, self.kept = programs, source, kept
        self.folder = source / "out" / "figures"
        self.folder.mkdir(parents=True, exist_ok=True)
        self.fresh, self.used = set(), []
        self.commit = commit or last_commit(source)

    def __call__(self, *command, output=None):
        """Returns the measurement of a command such as ("compare", "frames", "a.obj"). If `output` is given, such as
        ".exr" or "" for a folder, the program gets an -o with that ending."""
        command = [str(word) for word in command]
        key = hashlib.sha256("\0".join(command).encode()).hexdigest()[:12]
        file, target = self.folder / f"{key}.json", f"out/figures/{key}{output}"
        if not file.exists() or not (self.kept or key in self.fresh):
            print("  " + " ".join(command), flush=True)
            self.measure(command, file, [] if output is None else ["-o", target], target)
        self.fresh.add(key)
        measurement = Measurement(**json.loads(file.read_text(encoding="utf-8")))
        if measurement not in self.used:
            self.used.append(measurement)
        return measurement

    def generate(self, mesh):
        """Makes models/generated/MESH.obj if it is missing: the build makes only those that scenes name."""
        if not (self.source / "models" / "generated" / f"{mesh}.obj").exists():
            subprocess.run([self.programs / "tools" / "generate", "models", mesh], cwd=self.source,
                           stdout=subprocess.DEVNULL, check=True)

    def measure(self, command, file, output, target):
        stats = file.with_suffix(".stats")
        stats.unlink(missing_ok=True)
        begin, busy, own = time.time(), busy_seconds(), own_seconds()
        result = subprocess.run([self.programs / command[0], *command[1:], *output, "--stats", stats], cwd=self.source,
                                capture_output=True, text=True, check=False)
        seconds = time.time() - begin
        # /proc/stat counts each processor's time in ticks. A difference of at most one tick per processor therefore
        # counts as 0.
        others = busy_seconds() - busy - (own_seconds() - own) - os.cpu_count() / os.sysconf("SC_CLK_TCK")
        if result.returncode != 0 or not stats.exists():
            raise Failed(f"{' '.join(command)}: exit code {result.returncode}\n{result.stderr.strip()[-1000:]}")
        measurement = Measurement(command, datetime.date.today().isoformat(), self.commit, processor(),
                                  max(0, others / (seconds * os.cpu_count())), seconds,
                                  json.loads(stats.read_text(encoding="utf-8")), target)
        stats.unlink()
        temporary = pathlib.Path(f"{file}.tmp")
        temporary.write_text(json.dumps(dataclasses.asdict(measurement)), encoding="utf-8")
        temporary.replace(file)
