"""Sets of takes, and their exchange file.

One NPZ: ``samples`` float (n, 3) in g, ``offsets`` int (m+1), ``labels`` str (m), ``activation`` int
(m, sample index inside the take, 0 if absent), optional ``user`` and ``session`` (m), ``rate_hz``.
"""
