#!/usr/bin/env python3
"""Where the tumbling bodies of long_flight_test.cpp are after 1e8 steps: to 25 digits.

The body-axes momentum of a torque-free body is periodic, and after each period the body has turned by
the same angle about its fixed angular momentum. The period comes from the complete elliptic integral
(Landau and Lifshitz, Mechanics, section 37), the rest from Taylor series of Euler's equations; no
formula is shared with the integrators. Needs python3-mpmath; takes half a minute.
"""
from mpmath import mp, mpf, ellipk, sqrt, floor, atan2, cos, sin

mp.dps = 40


def product(p, q):
    return [p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
            p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
            p[0] * q[2] + p[2] * q[0] + p[3] * q[1] - p[1] * q[3],
            p[0] * q[3] + p[3] * q[0] + p[1] * q[2] - p[2] * q[1]]


def series(I, m, q, order=40):
    """Taylor coefficients of m' = m x w, q' = q w / 2, w = m / I."""
    M = [[m[i]] for i in range(3)]
    Q = [[q[i]] for i in range(4)]

    def times(a, b, n):
        return sum(a[j] * b[n - j] for j in range(n + 1))

    for n in range(order):
        w = [[x / I[i] for x in M[i]] for i in range(3)]
        rate = [times(M[(i + 1) % 3], w[(i + 2) % 3], n) - times(M[(i + 2) % 3], w[(i + 1) % 3], n)
                for i in range(3)]
        turn = [-sum(times(Q[i + 1], w[i], n) for i in range(3))]
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            turn.append(times(Q[0], w[i], n) + times(Q[j + 1], w[k], n) - times(Q[k + 1], w[j], n))
        for i in range(3):
            M[i].append(rate[i] / (n + 1))
        for i in range(4):
            Q[i].append(turn[i] / (2 * (n + 1)))
    return M, Q


def fly(I, m, q, time, step):
    count = int(floor(time / step)) + 1
    h = time / count
    for _ in range(count):
        M, Q = series(I, m, q)
        m = [mp.polyval(c[::-1], h) for c in M]
        q = [mp.polyval(c[::-1], h) for c in Q]
    return m, q


def period(I, m):
    """Of the momentum, for I1 < I2 < I3."""
    L2 = sum(x * x for x in m)
    E2 = sum(x * x / i for x, i in zip(m, I))
    I1, I2, I3 = I
    if L2 > E2 * I2:
        rate = sqrt((I3 - I2) * (L2 - E2 * I1) / (I1 * I2 * I3))
        k2 = (I2 - I1) * (E2 * I3 - L2) / ((I3 - I2) * (L2 - E2 * I1))
    else:
        rate = sqrt((I2 - I1) * (E2 * I3 - L2) / (I1 * I2 * I3))
        k2 = (I3 - I2) * (L2 - E2 * I1) / ((I2 - I1) * (E2 * I3 - L2))
    return 4 * ellipk(k2) / rate


def after(I, w, q, time, step):
    I = [mpf(x) for x in I]
    m = [i * mpf(x) for i, x in zip(I, w)]
    q = [mpf(x) for x in q]
    T = period(I, m)
    m_T, q_T = fly(I, m, q, T, step)
    assert max(abs(a - b) for a, b in zip(m, m_T)) < mpf(10) ** -30, 'not periodic'
    # q_T = exp(angle L) q: a turn about L in the world.
    turn = product(q_T, [q[0], -q[1], -q[2], -q[3]])
    L = product(product(q, [mpf(0)] + m), [q[0], -q[1], -q[2], -q[3]])[1:]
    size = sqrt(sum(x * x for x in L))
    half = atan2(sum(t * x for t, x in zip(turn[1:], L)) / size, turn[0])
    count = floor(time / T)
    turns = [cos(count * half)] + [sin(count * half) * x / size for x in L]
    return product(turns, fly(I, m, q, time - count * T, step)[1])


if __name__ == '__main__':
    time = mpf(10) ** 8 * mpf(0.02)  # of the double nearest to 0.02
    for name, I, w, step in (('tumbling', (1, 2, 3), (0.125, 5, 0.125), mpf('0.02')),
                             ('stone', (1, 1.25, 2), (1.125, -2.25, 0.75), mpf('0.02'))):
        q = after(I, w, (0.5, -0.5, 0.5, 0.5), time, step)
        if q[0] < 0:
            q = [-x for x in q]
        print(name, *(mp.nstr(x, 25) for x in q))
