    // What was asked a cycle ago.
    always @(posedge clock) begin
        p_held <= t_held; p_on <= t_on; p_answer <= t_answer;
        p_asked <= t_address; p_refused <= t_refused; p_writes <= t_write; p_word <= t_word;
    end
