#include "screwline/spatial/svd.h"

template class Eigen::JacobiSVD<screwline::MatrixX>;
