from pathlib import Path

import pytest

from tests.guided.bench import Bench


@pytest.fixture
def bench(tmp_path: Path):
    made = Bench(tmp_path)
    yield made
    made.desk.close()
