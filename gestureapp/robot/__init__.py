"""The robot's end of the chain: codec, exchange, workspace, gate, guardian. Standard library only."""
