#ifndef SCREWLINE_SPATIAL_SINCOS_H
#define SCREWLINE_SPATIAL_SINCOS_H

namespace screwline {

/// sine[i], cosine[i] of angle[i] [rad], i < count, for |angle| <= 1e6; absolute error below 2.3e-16. No allocation;
/// the compiler vectorises it, which is why the chain's sines are taken together. Arrays may not overlap. Source: Cody
/// & Waite reduction in three parts, minimax polynomials on [-pi/4, pi/4] (as in fdlibm's kernel functions).
void sincosMany(const double* angle, double* sine, double* cosine, int count);

}  // namespace screwline

#endif  // SCREWLINE_SPATIAL_SINCOS_H
