"""A simulated person records with the desk that the guided thread drives; time is compressed."""

import itertools

from gestureapp.guided.values import Pace, Phase


def test_without_a_person_nothing_is_recorded_and_it_says_so(bench):
    bench.desk.start()
    bench.run(5.0)

    assert bench.picture.phase is Phase.CLOSED
    assert bench.picture.sentence == "Choose whose takes these are."


def test_a_batch_by_rhythm_counts_in_and_takes_ten_on_the_beat(bench):
    bench.desk.open("Ana")
    bench.desk.set_pace(Pace.RHYTHM, 1.5)
    bench.desk.start()
    begin_s = bench.now_s
    bench.tick()
    assert (bench.picture.phase, bench.picture.count_in) == (Phase.COUNT_IN, 3)
    bench.run(1.0)
    assert bench.picture.count_in == 2

    bench.run_until(lambda picture: picture.phase is Phase.IDLE)

    takes = bench.desk.takes
    assert len(takes) == 10
    assert [take.label for take in takes] == ["X+"] * 10
    assert abs(bench.now_s - begin_s - (3.0 + 9 * 1.5 + 1.1)) < 0.05
    steps = {round(b.wall_s - a.wall_s, 6) for a, b in itertools.pairwise(takes)}
    assert steps == {1.5}


def test_a_batch_hands_free_takes_ten_by_the_left_arm(bench):
    bench.desk.open("Ana")
    bench.run_batch()

    takes = bench.desk.takes
    assert len(takes) == 10
    assert all(take.times_s[0] >= -0.5 and take.times_s[-1] < 1.0 for take in takes)
    assert all(len(take.times_s) in (149, 150, 151) for take in takes)
