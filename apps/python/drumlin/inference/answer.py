"""What a posterior says, in numbers and in words: infer.json (docs/formats/infer.md)."""

import numpy as np

from . import posterior

SHARE = 0.9  # of the intervals that are written
DETERMINED, HARDLY = 0.4, 0.8  # width over the prior's: below, determined; above, not determined
LINKED = 0.7  # correlation from which two unknowns are named together
AT_THE_EDGE = 0.2  # share of the samples in the outermost twentieth of a range
FAR = 2  # standard deviations: what fits better than one number so far off is no misfit


def _interval(values, share=SHARE):
    return np.quantile(values, [(1 - share) / 2, (1 + share) / 2], axis=0)


def unknowns(of, samples):
    """{name: numbers} of each unknown, its width over that of its prior among them."""
    found = {}
    for name, prior, column in zip(of.names, of.priors, samples.T):
        low, high = _interval(column)
        alone = prior.quantile((1 + SHARE) / 2) - prior.quantile((1 - SHARE) / 2)
        margin = 0.05 * (prior.high - prior.low)
        found[name] = {"range": [prior.low, prior.high], "median": float(np.median(column)), "low": float(low), "high": float(high),
                       "mean": float(column.mean()), "sd": float(column.std()), "width_over_prior": float((high - low) / alone),
                       "at_low_end": float(np.mean(column < prior.low + margin)), "at_high_end": float(np.mean(column > prior.high - margin))}
    return found


def directions(of, samples):
    """Combinations of the unknowns, each over the standard deviation of its prior, from the best determined to the least: `sd` is 1 where nothing is known."""
    prior = of.of_prior(posterior.DRAWN)
    covariance = np.cov(((samples - prior.mean(axis=0)) / prior.std(axis=0)).T).reshape(len(of.names), -1)
    squares, vectors = np.linalg.eigh(covariance)
    return [{"sd": float(np.sqrt(max(square, 0))), "weights": dict(zip(of.names, map(float, vector * np.sign(vector[np.argmax(np.abs(vector))]))))}
            for square, vector in zip(squares, vectors.T)]


def data_rows(of, samples, scenes):
    """Of each number that was measured: what the posterior expects, how far off it lies, and what its uncertainty is made of."""
    rows = []
    for scene, datum, (mean, sd) in zip(scenes, of.data, of.predicted(samples)):
        _, *inner = datum.emulator.predict(of.unit(samples[:: max(1, len(samples) // 500)]))
        own, spread = (np.sqrt(np.mean(one**2, axis=0)) for one in inner)
        for k, (name, process) in enumerate(zip(datum.emulator.names, datum.emulator.processes)):
            parts = {"measurement": datum.errors[k], "emulator": own[k], "spread": spread[k] / np.sqrt(datum.realisations)}
            left_out = float(np.sqrt(np.nanmean(process.rest**2))) if len(process.rest) else None
            rows.append({"scene": scene.name, "name": name.removeprefix(f"{scene.name}: "), "value": float(datum.values[k]), "expected": float(mean[k]),
                         "expected_sd": float(sd[k]), "off": float((datum.values[k] - mean[k]) / sd[k]),
                         "sd": {part: float(value) for part, value in parts.items()}, "left_out_rms": left_out})
    return rows


def _determined(content):
    words = []
    for name, one in content["unknowns"].items():
        text = f"{name}: {one['median']:.3g} ({one['low']:.3g} to {one['high']:.3g})"
        width = one["width_over_prior"]
        if width > HARDLY:
            words.append(f"{name}: not determined by these data: the interval is {width:.0%} of the prior's, {one['low']:.3g} to {one['high']:.3g}")
        else:
            words.append(f"{text}, {'determined' if width < DETERMINED else 'hardly determined'}: {max(width, 0.01):.0%} of the width of the prior")
        for end, value in (("low", one["range"][0]), ("high", one["range"][1])):
            if width <= HARDLY and one[f"at_{end}_end"] > AT_THE_EDGE:
                words.append(f"{name}: lies at the {end} end of its range, {value:g}: what lies beyond may fit as well")
    return words


def _linked(content):
    names, words = list(content["unknowns"]), []
    for i, first in enumerate(names):
        for j, second in enumerate(names[:i]):
            correlation = content["correlations"][i][j]
            if abs(correlation) > LINKED:
                words.append(f"{second} and {first}: the data know a combination of both: with more {second} {'more' if correlation > 0 else 'less'} {first} "
                             f"fits as well (correlation {correlation:.2f})")
    return words


def combination(direction):
    """"0.80 friction + 0.60 rolling_resistance": what counts in it."""
    parts = sorted(direction["weights"].items(), key=lambda part: -abs(part[1]))
    text = ""
    for name, weight in parts:
        if abs(weight) >= 0.2:
            text += f"{' - ' if weight < 0 else ' + ' if text else ''}{abs(weight):.2f} {name}"
    return text.strip()


def _fit(content):
    fit = content["misfit"]
    if not fit["is_misfit"] and fit["data"] <= len(content["unknowns"]):
        return [f"the data fit, but {fit['data']} numbers of {len(content['unknowns'])} unknowns nearly always do"]
    if not fit["is_misfit"]:
        return [f"the data fit: {fit['share']:.0%} of data sets of such grains are as contradictory "
                f"(chi square {fit['chi_square']:.1f} of {fit['data']} numbers)"]
    words = [f"MISFIT: no grains in these ranges explain the data together: {fit['share']:.1%} of data sets of such grains are as contradictory "
             f"(chi square {fit['chi_square']:.1f} of {fit['data']} numbers); the intervals below mean nothing until the cause is found"]
    if len(fit["without"]) > 1:
        odd = min(fit["without"], key=fit["without"].get)
        words.append(f"{odd} contradicts the others most: chi square {fit['without'][odd]:.1f} without it")
    off = sorted(content["data"], key=lambda row: -abs(row["off"]))
    return words + [f"{row['scene']}, {row['name']}: {row['value']:.4g} where {row['expected']:.4g} +- {row['expected_sd']:.2g} is expected"
                    for row in off if abs(row["off"]) > 1.5 or row is off[0]]


def _more_runs(content):
    """Where the emulator, not the measurement, is what limits the answer."""
    names = [f"{row['scene']}, {row['name']}" for row in content["data"]
             if row["sd"]["emulator"] > max(row["sd"]["measurement"], row["sd"]["spread"])]
    return [f"more runs would help: of {'; '.join(names)} the emulator knows less than the measurement"] if names else []


def words(content):
    """The answer in sentences, the misfit first."""
    found = _fit(content) + _determined(content) + _linked(content)
    if len(content["unknowns"]) > 1:
        best, least = content["directions"][0], content["directions"][-1]
        found.append(f"best determined: {combination(best)}, to {best['sd']:.0%} of the prior; least: {combination(least)}, to {least['sd']:.0%}")
    return found + _law(content) + _more_runs(content)


def _law(content):
    law = content["law"]
    if law is None:
        return []
    at = [int(np.abs(np.log(np.array(law["I"]) / I)).argmin()) for I in (0.01, 0.1)]
    text = ", ".join(f"{law['mu'][k]:.3f} ({law['low'][k]:.3f} to {law['high'][k]:.3f}) at I = {law['I'][k]:.2g}" for k in at)
    return [f"law of such grains: mu = {text}"]


def answer(of, samples, scenes, law=None):
    """The numbers and words of infer.json."""
    fit = of.misfit(samples)
    content = {"unknowns": unknowns(of, samples), "correlations": np.corrcoef(samples.T).reshape(len(of.names), -1).tolist(),
               "directions": directions(of, samples), "data": data_rows(of, samples, scenes),
               "misfit": fit | {"is_misfit": bool(fit["share"] < posterior.MISFIT and fit["chi_square"] > FAR**2)}, "law": law, "samples": len(samples)}
    return content | {"words": words(content)}
