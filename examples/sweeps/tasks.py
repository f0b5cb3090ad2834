"""The points of field.json as tasks of HyperQueue, on a cluster of this machine's cores: python tasks.py

With a server that runs already (hq server start) and its workers in the allocations of a batch system, use Client() in place of the
local cluster. What is done is not run again.
"""

import subprocess

from hyperqueue import Job, LocalCluster
from hyperqueue.cluster import WorkerConfig

points = int(subprocess.run(["spinneb", "sweep", "field.json", "--count"], check=True, capture_output=True, text=True).stdout)
job = Job()
for index in range(points):
    job.program(["spinneb", "sweep", "field.json", "--index", str(index), "--threads", "1", "--quiet"], stdout=None, stderr=None)
with LocalCluster(worker_config=WorkerConfig()) as cluster:
    client = cluster.client()
    client.wait_for_jobs([client.submit(job)])
subprocess.run(["spinneb", "collect", "field.json"], check=True)
