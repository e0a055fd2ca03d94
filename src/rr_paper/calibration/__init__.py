"""The paper's prototype estimated from its nine measured averages, and models compared on them."""
