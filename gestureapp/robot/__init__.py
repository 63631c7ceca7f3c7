"""The robot's end of the chain, from gate to guardian. Standard library only."""
