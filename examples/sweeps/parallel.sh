#!/bin/sh
# The points of field.json by GNU parallel, as many at a time as there are cores; with --sshlogin on several machines.
# The log has a line a point: exit value 0 is certified, 3 is not.
last=$(($(spinneb sweep field.json --count) - 1))
seq 0 "$last" | parallel --joblog field.log spinneb sweep field.json --index {} --threads 1 --quiet
spinneb collect field.json
