from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.setup.bench import SetupBench


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[SetupBench]:
    """Two sensors on pseudo terminals that send level readings; somebody looks."""
    made = SetupBench(tmp_path)
    made.desk.look(True)
    made.connect()
    yield made
    made.close()
