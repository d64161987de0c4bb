"""python3 -m drillmbd"""
import sys

from .command import main

sys.exit(main())
