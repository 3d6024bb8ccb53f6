from .decomposition import decompose_fourier as decompose_fourier, decompose_pca as decompose_pca
