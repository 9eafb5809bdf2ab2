/* Makes the compiled simulator available in Octave as y = simulate(t, p, x). The parameters x are alpha,
 * beta, gamma, eta, k0, k1, c1, k2, c2 and the offset of y. */
#include "mex.h"

void simulate(size_t n, const double* t, const double* p, int branches, const double* x, double* y);

void mexFunction(int nlhs, mxArray* plhs[], int nrhs, const mxArray* prhs[]) {
  (void)nlhs;
  if (nrhs != 3) mexErrMsgTxt("simulate(t, p, x)");
  const size_t n = mxGetNumberOfElements(prhs[0]);
  const int branches = (int)((mxGetNumberOfElements(prhs[2]) - 6) / 2);
  plhs[0] = mxCreateDoubleMatrix(n, 1, mxREAL);
  simulate(n, mxGetPr(prhs[0]), mxGetPr(prhs[1]), branches, mxGetPr(prhs[2]), mxGetPr(plhs[0]));
}
