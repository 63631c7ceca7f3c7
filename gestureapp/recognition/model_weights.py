"""The part of a model file that depends on the kind of model: its weights and thresholds. Pure."""

from collections.abc import Mapping
from dataclasses import asdict

from gestureapp.recognition.decision import Decision
from gestureapp.recognition.ensemble import Ensemble, Layer
from gestureapp.recognition.fields import number_in, object_in, table_in
from gestureapp.recognition.network import Network
from gestureapp.recognition.window import N_INPUTS

KIND_PAPER = "paper"
KIND_ONSET = "onset"
WINDOW_SAMPLES = 3
"""Samples of the right arm that the network of kind ``paper`` sees. Source: paper, IV.B."""
N_INPUTS_OF = {KIND_PAPER: 3 * WINDOW_SAMPLES, KIND_ONSET: N_INPUTS}
MOST_LAYERS = 8


def weights_of(network: Network | Ensemble) -> dict[str, object]:
    """As plain values for ``json.dumps``."""
    if isinstance(network, Network):
        return {
            "hidden": network.hidden.tolist(),
            "hidden_bias": network.hidden_bias.tolist(),
            "output": network.output.tolist(),
            "output_bias": network.output_bias.tolist(),
        }
    return {
        "mean": network.mean.tolist(),
        "scale": network.scale.tolist(),
        "layers": [
            {"weights": layer.weights.tolist(), "bias": layer.bias.tolist()}
            for layer in network.layers
        ],
        "temperature": network.temperature,
    }


def network_in(content: Mapping[str, object], kind: str, n_labels: int) -> Network | Ensemble:
    """The network of a model file.

    Args:
        content: The whole file.
        kind: Of the model.
        n_labels: How many gestures it must tell apart.

    Raises:
        ValueError: it is damaged, or does not fit the rest; the text says why in a line.
    """
    if kind not in N_INPUTS_OF:
        raise ValueError(f"unknown kind {kind!r}")
    weights = object_in(content, "weights")
    network = _network(weights) if kind == KIND_PAPER else _ensemble(weights)
    shape, n_inputs = list(network.shape), N_INPUTS_OF[kind]
    if shape != content.get("shape"):
        raise ValueError(f"'shape' says {content.get('shape')!r}, the weights {shape}")
    if shape[0] != n_inputs:
        raise ValueError(f"it has {shape[0]} inputs, expected {n_inputs}")
    n_outputs = shape[-1] - (kind == KIND_ONSET)
    if n_outputs != n_labels:
        raise ValueError(f"{n_outputs} outputs for {n_labels} labels")
    return network


def decision_of(decision: Decision) -> dict[str, object]:
    """As plain values for ``json.dumps``."""
    return asdict(decision)


def decision_in(content: Mapping[str, object], kind: str) -> Decision | None:
    """The thresholds of a model of kind ``onset``; None of another.

    Raises:
        ValueError: they are missing or out of range.
    """
    if kind != KIND_ONSET:
        return None
    found = object_in(content, "decision")
    return Decision(**{name: number_in(found, name) for name in Decision.__slots__})


def _network(weights: Mapping[str, object]) -> Network:
    return Network(
        hidden=table_in(weights, "hidden", 2),
        hidden_bias=table_in(weights, "hidden_bias", 1),
        output=table_in(weights, "output", 2),
        output_bias=table_in(weights, "output_bias", 1),
    )


def _ensemble(weights: Mapping[str, object]) -> Ensemble:
    layers = weights.get("layers")
    if not isinstance(layers, list) or not 0 < len(layers) <= MOST_LAYERS:
        raise ValueError("'layers' is missing")
    if not all(isinstance(layer, dict) for layer in layers):
        raise ValueError("'layers' must hold objects")
    return Ensemble(
        mean=table_in(weights, "mean", 2),
        scale=table_in(weights, "scale", 2),
        layers=tuple(Layer(table_in(x, "weights", 3), table_in(x, "bias", 2)) for x in layers),
        temperature=number_in(weights, "temperature"),
    )
