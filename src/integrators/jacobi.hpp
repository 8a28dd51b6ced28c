#pragma once

namespace rigid_body_sim {

/// Jacobi's elliptic functions of one argument.
struct Jacobi {
  double sn;
  double cn;
  double dn;
};

/// sn, cn, dn of v for the modulus k, given as k^2 and k'^2 = 1 - k^2 so that neither loses digits.
/// Accurate for |v| up to the quarter period K; k' = 0 gives the hyperbolic functions.
Jacobi jacobi(double v, double k2, double kc2);

/// Quarter period K [rad of v] for k'^2 > 0: pi / (2 agm(1, k')).
double quarterPeriod(double kc2);

/// Integral of sn^2 / (1 - n sn^2) from 0 to v, with |v| <= K and f = jacobi(v); n <= 1 is given
/// with 1 - n, so that it stays accurate when n is near 1.
double integralOfThirdKind(const Jacobi& f, double k2, double n, double one_minus_n);

/// The same from 0 to K, for k'^2 > 0.
double completeIntegralOfThirdKind(double kc2, double one_minus_n);

}  // namespace rigid_body_sim
