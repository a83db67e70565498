"""Which process wrote something, so that others can tell later whether it is still alive."""

import os
from pathlib import Path


def this_process() -> str:
    """A name of this process that none after it will have: its id, when it began, and the boot (Linux); else its id."""
    return _name_of(os.getpid())


def is_alive(process: str) -> bool:
    """True if the process that `this_process` named so, on this machine, still runs."""
    pid = int(process.partition("-")[0])
    if Path("/proc").exists():
        return process == _name_of(pid)
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True


def _name_of(pid: int) -> str:
    if not Path("/proc").exists():
        return str(pid)
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except (FileNotFoundError, ProcessLookupError):
        return ""
    state, began = fields[0], fields[19]  # clock ticks since the boot
    boot = Path("/proc/sys/kernel/random/boot_id").read_text()[:8]
    return "" if state == "Z" else f"{pid}-{began}-{boot}"
