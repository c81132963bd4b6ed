"""An agent on servers of racebeam.cluster. It compares them with games in this process, and goes on when one is
cancelled."""

import numpy as np
from racebeam import AtariVectorEnv
from racebeam.cluster import SlurmServers

with SlurmServers(4, wait=100, timeout_min=5) as addresses:
    there, here = (AtariVectorEnv("beamfall", 8, server=server, seed=1) for server in (addresses, None))
    for step in range(20):
        actions = np.full(8, step % 3)
        assert np.array_equal(there.step(actions)[0], here.step(actions)[0])
    there.close()

servers = SlurmServers(4, wait=100, timeout_min=5)
with servers as addresses:
    envs = AtariVectorEnv("beamfall", 8, server=addresses)
    servers.jobs[1].cancel()
    losses = np.zeros(8, bool)
    while not losses.any():
        losses = envs.step(np.zeros(8, int))[-1]["lost"]
    assert not envs.step(np.zeros(8, int))[-1]["lost"].any()
    envs.close()
print(f"the same; {losses.sum()} environments were lost, and played on")
