#!/usr/bin/env bash
# Prints the state of a job with the words of Snakemake: running, success or failed. Without accounting, Slurm
# forgets a finished job after the time MinJobAge. Snakemake asks at shorter intervals.
state=$(scontrol show job "$1" 2>/dev/null | sed -n 's/.*JobState=\([A-Z_]*\).*/\1/p' | head -n 1)
case $state in
  COMPLETED) echo success ;;
  PENDING | CONFIGURING | RUNNING | COMPLETING | SUSPENDED | REQUEUED) echo running ;;
  *) echo failed ;;
esac
