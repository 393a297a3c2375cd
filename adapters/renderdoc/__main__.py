"""python3 adapters/renderdoc FRAME.rdc -o DIR: see gnomon_frame/cli.py."""
import sys

from gnomon_frame.cli import main

sys.exit(main())
