"""A Slurm cluster of several nodes on this machine: munged, slurmctld, and a slurmd for each node, in a folder of their
own.

It needs root, and Debian's packages slurmctld, slurmd, slurm-client and munge.
"""

import contextlib
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import tempfile
import time

NEEDED = ("munged", "slurmctld", "slurmd", "sbatch", "srun", "scontrol")
PATIENCE = float(os.environ.get("RACEBEAM_PATIENCE", 20)) * 6  # seconds; jobs start every few seconds
SLURMD_TIMEOUT = 300  # seconds
TOP = pathlib.Path(__file__).resolve().parents[2]


def missing():
    """What this machine lacks for a cluster, as a sentence, or None."""
    if os.geteuid() != 0:
        return "the cluster needs root"
    missing = [name for name in NEEDED if shutil.which(name) is None]
    return f"not installed: {', '.join(missing)}" if missing else None


def free_ports(count):
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    try:
        return [each.getsockname()[1] for each in sockets]
    finally:
        for each in sockets:
            each.close()


def processes(*marks):
    """The command lines of processes whose environment has all `marks`: variables and their values."""
    found = {}
    for entry in pathlib.Path("/proc").iterdir():
        try:
            if entry.name.isdecimal() and {mark.encode() for mark in marks} <= set(
                (entry / "environ").read_bytes().split(b"\0")
            ):
                found[int(entry.name)] = (entry / "cmdline").read_bytes().replace(b"\0", b" ").decode()
        except OSError:
            continue
    return found


def parent(number):
    """Returns the parent of a process; 0 if the process has ended."""
    try:
        return int(pathlib.Path(f"/proc/{number}/stat").read_text().rsplit(")", 1)[1].split()[1])
    except OSError:
        return 0


def name_of(number):
    try:
        return pathlib.Path(f"/proc/{number}/comm").read_text().strip()
    except OSError:
        return ""


CONFIGURATION = """
ClusterName=racebeam
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={control_port}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket
CryptoType=crypto/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_min_interval=10000,batch_sched_delay=0,bf_interval=1,defer_batch=0
SchedulerTimeSlice=5
PreemptMode=REQUEUE
PreemptType=preempt/partition_prio
KillWait=5
InactiveLimit=0
MinJobAge=300
MaxArraySize=1001
MaxJobCount=5000
ReturnToService=2
SlurmdTimeout={slurmd_timeout}
SlurmdParameters=config_overrides
UnkillableStepTimeout=60
PrologFlags=NoHold
{nodes}
PartitionName=work Nodes=ALL Default=YES MaxTime=INFINITE State=UP PriorityTier=1 OverSubscribe=FORCE:64
PartitionName=urgent Nodes=ALL MaxTime=INFINITE State=UP PriorityTier=10
"""


class Cluster:
    """Started by `with`, and gone at its end. `folder` stands for the shared file system."""

    def __init__(self, nodes=4, processors=4):
        self.nodes = [f"n{number}" for number in range(1, nodes + 1)]
        self.processors = processors
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="racebeam-cluster-", dir="/tmp"))
        self.daemons = {}
        self.environment = {
            name: value for name, value in os.environ.items() if not name.startswith(("SLURM_", "RACEBEAM_"))
        }
        self.environment["SLURM_CONF"] = str(self.folder / "slurm.conf")

    def __enter__(self):
        try:
            self.configure()
            self.start()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        subprocess.run(["scancel", "--user=root"], env=self.environment, capture_output=True)
        for process in reversed(self.daemons.values()):
            process.terminate()
        for process in self.daemons.values():
            try:
                process.wait(PATIENCE)
            except subprocess.TimeoutExpired:
                process.kill()
        shutil.rmtree(self.folder, ignore_errors=True)

    def configure(self):
        control_port, *ports = free_ports(1 + len(self.nodes))
        host = socket.gethostname().partition(".")[0]
        nodes = "\n".join(
            f"NodeName={name} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs={self.processors} "
            "RealMemory=1000 State=UNKNOWN"
            for name, port in zip(self.nodes, ports)
        )
        for name in ("state", "jobs", "munge"):
            (self.folder / name).mkdir(mode=0o755)
        self.folder.chmod(0o755)
        (self.folder / "munge/key").write_bytes(os.urandom(128))
        (self.folder / "munge/key").chmod(0o400)
        text = CONFIGURATION.format(
            folder=self.folder, host=host, control_port=control_port, nodes=nodes, slurmd_timeout=SLURMD_TIMEOUT
        )
        (self.folder / "slurm.conf").write_text(text)

    def start(self):
        munge = self.folder / "munge"
        self.daemon(
            "munged",
            "munged",
            "--foreground",
            "--force",
            f"--key-file={munge}/key",
            f"--socket={munge}/socket",
            f"--pid-file={munge}/pid",
            f"--log-file={munge}/log",
            f"--seed-file={munge}/seed",
            "--num-threads=4",
        )
        self.wait("munged", lambda: (munge / "socket").exists())
        self.daemon("slurmctld", "slurmctld", "-D", "-c")
        for name in self.nodes:
            self.start_node(name)
        self.wait("the nodes", lambda: self.run("sinfo", "-h", "-o", "%T %D").split() == ["idle", str(len(self.nodes))])

    def start_node(self, name):
        self.daemon(name, "slurmd", "-D", "-c", "-N", name)

    def restart_node(self, name):
        self.start_node(name)
        self.wait(
            f"the node {name}", lambda: not re.search(r"down|\*", self.run("sinfo", "-h", "-n", name, "-o", "%T"))
        )

    def kill_node(self, name):
        """Kills the slurmd of a node, and the processes of its jobs, as a power failure does."""
        self.daemons[name].kill()
        self.daemons[name].wait()
        jobs = processes(f"SLURM_CONF={self.environment['SLURM_CONF']}", f"SLURMD_NODENAME={name}")
        for number in {parent(number) for number in jobs if name_of(parent(number)) == "slurmstepd"} | set(jobs):
            with contextlib.suppress(ProcessLookupError):
                os.kill(number, signal.SIGKILL)

    def set_slurmd_timeout(self, seconds):
        """After so long without an answer, slurmctld takes a node to have failed."""
        path = self.folder / "slurm.conf"
        path.write_text(re.sub(r"(?m)^SlurmdTimeout=.*", f"SlurmdTimeout={seconds}", path.read_text()))
        self.run("scontrol", "reconfigure")

    def daemon(self, name, *command):
        with open(self.folder / f"{name}.out", "ab") as log:
            self.daemons[name] = subprocess.Popen(
                command, env=self.environment, stdin=subprocess.DEVNULL, stdout=log, stderr=log, start_new_session=True
            )

    def wait(self, what, found, patience=PATIENCE):
        """Waits until `found` returns something true, and returns it."""
        until = time.monotonic() + patience
        while not (value := found()):
            if time.monotonic() > until:
                raise AssertionError(
                    f"{what}: not in {patience} seconds\n{self.run('squeue', check=False)}\n{self.logs()}"
                )
            time.sleep(0.1)
        return value

    def logs(self):
        return "\n".join(
            f"== {path.name}\n" + path.read_text(errors="replace")[-1500:]
            for path in sorted(self.folder.glob("*.log")) + sorted(self.folder.glob("*.out"))
        )

    def run(self, *command, check=True, **environment):
        """Runs a command of Slurm in the folder of the jobs. Returns what it prints."""
        done = subprocess.run(
            command,
            env=self.environment | environment,
            cwd=self.folder / "jobs",
            capture_output=True,
            text=True,
            timeout=PATIENCE,
        )
        if check and done.returncode != 0:
            raise AssertionError(f"{' '.join(map(str, command))}: status {done.returncode}, {done.stdout}{done.stderr}")
        return done.stdout

    def submit(self, *words, **environment):
        """Submits a job. Returns its number."""
        return self.run("sbatch", "--parsable", *map(str, words), **environment).strip()

    def state(self, job):
        """The states of a job and its elements, such as {"COMPLETED"}."""
        output = self.run("scontrol", "--oneliner", "show", "job", job, check=False)
        return {word.partition("=")[2] for word in output.split() if word.startswith("JobState=")}

    def field(self, name, element):
        """What scontrol says of an element of an array, such as its NodeList."""
        return re.search(rf" {name}=(\S*)", self.run("scontrol", "--oneliner", "show", "job", element))[1]

    def restarts(self, element):
        """How often it was requeued."""
        return int(self.field("Restarts", element))

    def hurry(self):
        """Starts what Slurm would hold back: requeued jobs for two minutes, and those that a busy node did not
        launch."""
        for line in self.run("squeue", "-h", "-t", "PENDING", "-o", "%i %r", check=False).splitlines():
            job, _, reason = line.partition(" ")
            if reason == "BeginTime":
                self.run("scontrol", "update", f"jobid={job}", "starttime=now", check=False)
            elif "launch failed" in reason:
                self.run("scontrol", "release", job, check=False)

    def wait_for_end(self, job, patience=PATIENCE):
        """Waits until a job and all its elements have ended. Returns their states."""
        waiting = {"PENDING", "RUNNING", "COMPLETING", "CONFIGURING", "SUSPENDED", "REQUEUED"}

        def has_ended():
            self.hurry()
            states = self.state(job)
            return states and not states & waiting

        self.wait(f"the end of job {job}", has_ended, patience)
        return self.state(job)

    def output(self, name):
        return (self.folder / "jobs" / name).read_text()
