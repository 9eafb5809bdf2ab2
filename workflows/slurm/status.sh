#!/usr/bin/env bash
# What became of a job, in Snakemake's words: running, success or failed. Without accounting Slurm forgets a job after a
# while (MinJobAge); Snakemake asks more often than that.
state=$(scontrol show job "$1" 2>/dev/null | sed -n 's/.*JobState=\([A-Z_]*\).*/\1/p' | head -n 1)
case $state in
  COMPLETED) echo success ;;
  PENDING | CONFIGURING | RUNNING | COMPLETING | SUSPENDED | REQUEUED) echo running ;;
  *) echo failed ;;
esac
