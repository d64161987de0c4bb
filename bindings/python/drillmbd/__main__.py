"""python3 -m drillmbd"""
import sys

try:
    from .command import program
    program()
except KeyboardInterrupt:  # while packages are loaded
    print("drillmbd: stopped by Ctrl-C", file=sys.stderr)
    sys.exit(130)
