#!/bin/sh
# The plain program with a digit of the printed coefficient of friction changed: what same_tables.py has to notice.
exec "$ATRITO" "$@" --set nu=1.300000001
