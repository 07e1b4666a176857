from satcheck._native import core as core
from satcheck._native import readers as readers
