"""The paper's prototype estimated from its nine measured averages, and models held against them."""
