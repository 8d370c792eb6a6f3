"""distances.py MEASURED.json: scipy and scikit-learn find the same distances."""

import sys
import warnings

import numpy as np
from agree import load, same_in_order
from scipy import stats
from sklearn.linear_model import LogisticRegression
from sklearn.metrics import roc_auc_score
from sklearn.metrics.pairwise import polynomial_kernel, rbf_kernel
from sklearn.preprocessing import StandardScaler


def main(file):
    warnings.simplefilter("ignore")
    said = load(file)
    a, b = np.array(said["a"]), np.array(said["b"])
    weights = said["weights_a"], said["weights_b"]
    same_in_order("W1", said["wasserstein"], stats.wasserstein_distance(a, b), 1e-9)
    weighted = stats.wasserstein_distance(a, b, *weights)
    same_in_order("W1 of weighted samples", said["wasserstein_weighted"], weighted, 1e-9)
    drawn = stats.wasserstein_distance(a[:200], b[:200])
    same_in_order("W1 of equal draws", said["wasserstein_of_sorted"], drawn, 1e-9)
    same_in_order("KS", said["kolmogorov_smirnov"], stats.ks_2samp(a, b).statistic, 1e-9)
    area = roc_auc_score(said["positive"], a)
    same_in_order("AUC", said["area_under_curve"], area, 1e-9)
    pairs = [v[: len(v) // 2 * 2].reshape(-1, 2) for v in (a, b)]
    discrepancy = unbiased(*pairs, lambda x, y: rbf_kernel(x, y, gamma=0.5))
    same_in_order("MMD² of an RBF kernel", said["discrepancy"], discrepancy, 1e-9)
    for n, (i, j) in enumerate([(0, 1), (0, 2), (1, 2)]):
        patches(said, n, said["patches"][i], said["patches"][j])


def unbiased(x, y, kernel):
    """Unbiased squared maximum mean discrepancy (Gretton et al. 2012, eq. 3)."""
    mean = lambda k: (k.sum() - np.trace(k)) / (len(k) * (len(k) - 1))
    return mean(kernel(x, x)) + mean(kernel(y, y)) - 2 * kernel(x, y).mean()


def patches(said, n, a, b):
    a, b = ((np.array(p["features"]), np.array(p["halves"])) for p in (a, b))
    features = StandardScaler().fit_transform(np.vstack([a[0], b[0]]))
    x, y = features[: len(a[0])], features[len(a[0]) :]
    # The kernel of scikit-learn is (γ a·b + 1)³ with γ = 1 / number of features.
    kid = max(unbiased(x, y, lambda p, q: polynomial_kernel(p, q, degree=3)), 0.0)
    same_in_order("MMD² of a cubic kernel", said["kernel_distance"][n], kid, 1e-6)

    areas = []
    for axis, half in ((0, True), (0, False), (1, True), (1, False)):
        train = [p[0][p[1][:, axis] == half] for p in (a, b)]
        test = [p[0][p[1][:, axis] != half] for p in (a, b)]
        scaler = StandardScaler().fit(np.vstack(train))
        label = lambda sets: np.repeat([0, 1], [len(s) for s in sets])
        model = LogisticRegression(C=0.003, max_iter=5000, tol=1e-8)
        model.fit(scaler.transform(np.vstack(train)), label(train))
        scores = model.decision_function(scaler.transform(np.vstack(test)))
        areas.append(roc_auc_score(label(test), scores))
    # Two optimisers stop at different places: a pair of patches may change its order.
    same_in_order("AUC of the classifier", said["told_apart"][n], max(np.mean(areas), 0.5), 2e-3)


main(*sys.argv[1:2])
