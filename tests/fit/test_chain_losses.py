"""What chains leave of a fit, against a plain least-squares solver, and how few of them are tried."""

import numpy as np
import pytest

from tests.fit.profile_world import fine_channels, low_passed, misfit_of, read_run, rough_road
from tests.fit.test_chain_estimate import delayed
from vehgen.fit import chain_estimate
from vehgen.fit.chain_estimate import ChainSearch
from vehgen.fit.chain_losses import ChainTrials, StoredRuns, group_delay
from vehgen.fit.least_squares import WEAK_PRIOR_SIGMA
from vehgen.fit.linearisation import linearise
from vehgen.fit.nuisances import Nuisances
from vehgen.measure.acquisition import AcquisitionChain


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    road = rough_road()
    recorded = low_passed(fine_channels(road, 12.0), 4, 22.0)
    misfit, x = misfit_of(read_run(tmp_path_factory.mktemp("run"), recorded, 12.0, road), Nuisances(0.05, 0.005))
    return StoredRuns.of(misfit, delayed(misfit, x, group_delay(AcquisitionChain("butterworth", 4, 22.0))))


def test_the_loss_through_the_stated_chains_is_that_of_a_plain_least_squares_solver(runs):
    misfit, x, n = runs.misfit, runs.x, runs.misfit.n_parameters
    jacobian, residuals = linearise(misfit, x).jacobian[:, runs.free], misfit.residuals(x)
    weak = np.eye(n, jacobian.shape[1]) / WEAK_PRIOR_SIGMA
    rows, left = np.vstack([jacobian, weak]), np.concatenate([residuals, np.zeros(n)])
    y = np.linalg.lstsq(rows, -left, rcond=None)[0]
    assert ChainSearch(runs).stated_loss() == pytest.approx(float(np.sum((left + rows @ y) ** 2)), rel=1e-4)


def test_a_chain_leaves_the_same_whether_it_is_tried_for_all_channels_or_stays_for_some(runs):
    names = runs.misfit.problem.trials[0].channels
    chain = AcquisitionChain("bessel", 2, 17.0)
    together = ChainTrials(runs, names, {}).fit(chain)
    assert together.chain.delay == -group_delay(chain)
    for own in (names[:1], names[1:]):
        others = dict.fromkeys([name for name in names if name not in own], together.chain)
        assert ChainTrials(runs, own, others).loss(together.chain) == pytest.approx(together.loss, rel=1e-9)
    assert ChainTrials(runs, (), dict.fromkeys(names, together.chain)).loss() == pytest.approx(together.loss, rel=1e-9)


def test_a_cut_off_is_refined_in_few_steps_and_only_of_chains_that_may_be_the_best(runs, monkeypatch):
    tried = []
    known = ChainTrials.fit
    monkeypatch.setattr(ChainTrials, "fit", lambda self, chain: tried.append(chain) or known(self, chain))
    found = ChainSearch(runs).estimate(runs.misfit.problem.trials[0].channels)
    assert found.best.chain.cut_off == pytest.approx(22.0, rel=0.03)
    grid = len(chain_estimate.CUT_OFF_SHARES)
    counts = {kind: sum((item.filter, item.order) == kind for item in tried) - grid for kind in chain_estimate.LOW_PASSES}
    assert 1 <= counts["butterworth", 4] <= chain_estimate.MOST_REFINED
    assert counts["bessel", 2] == 0


def test_a_curve_through_losses_finds_where_they_are_lowest():
    places = np.log(chain_estimate.CUT_OFF_SHARES)
    assert chain_estimate._lowest(places, 3.0 + (places + 1.2) ** 2) == pytest.approx((-1.2, 3.0))
    assert chain_estimate._lowest(places, -places) == pytest.approx((places[-1], -places[-1]))


@pytest.mark.parametrize(("falls", "sweeps"), [((48.0, 149.0), 1), ((54.0, 98.0), 2), ((54.0, 104.0), 2)])
def test_sensors_own_chains_are_not_sought_again_where_the_first_time_led_nowhere(runs, monkeypatch, falls, sweeps):
    search, parts = ChainSearch(runs), tuple((name,) for name in runs.misfit.problem.trials[0].channels)
    shared = chain_estimate.ChainFit(AcquisitionChain(), runs.size + 150.0)
    losses = [shared.loss - fall for fall in falls for _ in parts]
    given = iter(losses)

    def estimate(self, channels, beside):
        return chain_estimate.ChainEstimate(chain_estimate.ChainFit(AcquisitionChain(), next(given)), (), 1.0, True)

    monkeypatch.setattr(ChainSearch, "rough_loss", lambda self, part, known: 0.0)
    monkeypatch.setattr(ChainSearch, "estimate", estimate)
    assert bool(search.estimate_apart(parts, shared)) == (falls[-1] > 100.0 and sweeps == 2)
    assert len(losses) - len(list(given)) == sweeps * len(parts)
