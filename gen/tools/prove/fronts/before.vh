    reg p_held = 0, p_on = 0, p_answer = 0, p_writes = 0, p_refused = 0;
    reg [10:0] p_asked = 0;
    reg [31:0] p_word = 0;
