#include "model/chain.h"

#include "model/chain_walk.h"
#include "model/dual.h"

namespace softgrip::model {

template class Chain<double>;
template double Chain<double>::peek(const double&, const double&, Surroundings) const;
template Dual<double> Chain<double>::peek(const double&, const Dual<double>&, Surroundings) const;

}  // namespace softgrip::model
